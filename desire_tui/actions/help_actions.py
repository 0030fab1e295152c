"""Help pages, keys, configuration, notebook."""

from __future__ import annotations

from desire_tui.actions import Controller
from desire_tui.common import config
from desire_tui.common.paths import config_file
from desire_tui.editor.buffer import Buffer
from desire_tui.language.line_tokens import first_word


class HelpActions(Controller):
    """Part `help` of the command table."""

    def word(self, argument: str = "") -> None:
        """Show the page of a topic: the one named, or the word at the cursor."""
        app = self.app
        focused = app.focused
        if not argument and focused is app.editor.front:
            argument = app.editor.front.word_at_cursor()
            row = app.editor.front.cursor_location[0]
            if not argument and (marks := app.editor.front.marks.problems.get(row)):
                argument = str(marks[0].code)
        elif not argument and focused is app.command.prompt:
            argument = first_word(app.command.prompt.value)
        app.open_side("help")
        app.help_pane.show_topic(argument)

    async def keys(self, argument: str = "") -> None:
        """Show all keys on a sheet; carry out what is chosen there."""
        del argument
        from desire_tui.panes.key_sheet import KeySheet, entries
        from desire_tui.panes.own_keys import OWN_KEYS

        rows = entries(self.app.settings.keys, OWN_KEYS)
        if command_id := await self.app.push_screen_wait(KeySheet(rows)):
            self.app.do(command_id)

    def tour(self, argument: str = "") -> None:
        """Begin the tour, or go to its next step."""
        del argument
        self.app.tour.step()

    async def config(self, argument: str = "") -> None:
        """Open the configuration in a tab, filled with the defaults if there is none."""
        del argument
        path = config_file()
        if path.exists():
            await self.app.file_actions.open_path(path)
            return
        buffer = Buffer(path=path, saved_text="")
        area = await self.app.editor.add(buffer, config.defaults_text())
        area.focus()
