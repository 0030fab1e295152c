"""What is shown, and what has the focus."""

from __future__ import annotations

from io import StringIO
from typing import TYPE_CHECKING

from textual.widgets import Input, TextArea

from desire_tui.actions import Controller
from desire_tui.common import themes
from desire_tui.panes.side_pane import NAMES as SIDE_PAGES

if TYPE_CHECKING:
    from textual.widget import Widget

COLUMNS_STEP = 2
"""Columns that a pane gets at once."""


class ViewActions(Controller):
    """Part `view` of the command table."""

    def _panes(self) -> list[Widget]:
        app = self.app
        panes: list[Widget] = [app.editor.front, app.command.prompt, app.graph]
        if (side := app.side_focus()) is not None:
            panes.append(side)
        return panes

    def _step(self, by: int) -> None:
        panes = self._panes()
        focused = self.app.focused
        here = next(
            (n for n, pane in enumerate(panes) if focused is pane or (focused and pane in focused.ancestors)),
            0,
        )
        for distance in range(1, len(panes) + 1):
            pane = panes[(here + by * distance) % len(panes)]
            if self.app.move_focus(pane):
                return

    def next_pane(self, argument: str = "") -> None:
        """Move the focus to the next pane."""
        del argument
        self._step(1)

    def previous_pane(self, argument: str = "") -> None:
        """Move the focus to the pane before."""
        del argument
        self._step(-1)

    def command_line(self, argument: str = "") -> None:
        """Move the focus to the command line."""
        del argument
        self.app.move_focus(self.app.command.prompt)

    def editor(self, argument: str = "") -> None:
        """Move the focus to the editor."""
        del argument
        self.app.move_focus(self.app.editor.front)

    def maximize(self, argument: str = "") -> None:
        """Show the focused pane alone, or all panes."""
        del argument
        self.app.toggle_maximized(None)

    def _grow(self, columns: int, rows: int) -> None:
        screen = self.app.main_screen
        if not screen.splits.grow(screen.pane_of(self.app.focused), columns, rows):
            self.app.notify("No other pane stands there.", timeout=2)

    def wider(self, argument: str = "") -> None:
        """Make the focused pane wider."""
        del argument
        self._grow(COLUMNS_STEP, 0)

    def narrower(self, argument: str = "") -> None:
        """Make the focused pane narrower."""
        del argument
        self._grow(-COLUMNS_STEP, 0)

    def higher(self, argument: str = "") -> None:
        """Make the focused pane higher."""
        del argument
        self._grow(0, 1)

    def lower(self, argument: str = "") -> None:
        """Make the focused pane lower."""
        del argument
        self._grow(0, -1)

    def even(self, argument: str = "") -> None:
        """Let the panes have the places they have by themselves."""
        del argument
        self.app.main_screen.splits.reset()

    def graph(self, argument: str = "") -> None:
        """Move the focus to the graph."""
        del argument
        self.app.move_focus(self.app.graph)

    async def jump(self, argument: str = "") -> None:
        """Label panes and tabs, and go where the next letter says."""
        del argument
        from desire_tui.actions.jump import JumpScreen, targets

        target = await self.app.push_screen_wait(JumpScreen(list(targets(self.app))))
        if target is not None:
            self.app.do(target.command_id, target.argument)

    def side(self, argument: str = "") -> None:
        """Show a page of the side pane and move there."""
        for name in SIDE_PAGES:
            if name == argument:
                self.app.open_side(name)
                if name == "help":
                    self.app.help_pane.show_topic("")

    def tab(self, argument: str = "") -> None:
        """Show the tab of a number, as the buffers are numbered."""
        area = self.app.editor.find(int(argument)) if argument else None
        if area is not None:
            self.app.editor.show(area, focus=True)

    def quantities(self, argument: str = "") -> None:
        """Show the quantities; pressed again, hide them."""
        del argument
        self.app.open_side("quantities", toggle=True)

    def problems(self, argument: str = "") -> None:
        """Show the problems; pressed again, hide them."""
        del argument
        self.app.open_side("problems", toggle=True)

    def hide(self, argument: str = "") -> None:
        """Hide the side pane."""
        del argument
        self.app.close_side()

    def theme(self, argument: str = "") -> None:
        """Change to the named theme, or to the next of ours."""
        app = self.app
        if argument and argument not in app.available_themes:
            app.notify(f"No theme '{argument}'. There are: {', '.join(app.available_themes)}", markup=False)
            return
        names = themes.NAMES
        at = names.index(app.theme) if app.theme in names else -1
        app.choose_theme(argument or names[(at + 1) % len(names)])
        app.notify(f"Theme: {app.theme}", timeout=1.5, markup=False)

    def search_output(self, argument: str = "") -> None:
        """Search the command pane's output."""
        del argument
        self.app.move_focus(self.app.command.prompt)
        self.app.command.open_search()

    async def history(self, argument: str = "") -> None:
        """List the commands of this and former sessions; the one chosen goes to the command line."""
        del argument
        from desire_tui.panes.history_list import HistoryList

        prompt = self.app.command.prompt
        if line := await self.app.push_screen_wait(HistoryList(prompt.history.lines)):
            self.app.move_focus(prompt)
            prompt.value = line
            prompt.cursor_position = len(line)

    @property
    def selected_text(self) -> str:
        """What is selected with mouse or keys."""
        focused = self.app.focused
        text = self.app.screen.get_selected_text() or ""
        return focused.selected_text if not text and isinstance(focused, (TextArea, Input)) else text

    def copy_selection(self) -> None:
        """Copy what is selected."""
        if text := self.selected_text:
            self.copy(text)
        else:
            self.app.notify("Nothing is running. Ctrl+Q leaves Desire.", timeout=2)

    def copy(self, text: str) -> None:
        """Put text on the clipboard by OSC 52, and say what the terminal may do with it."""
        self.app.copy_to_clipboard(text)
        lines = text.count("\n") + 1
        self.app.notify(
            f"Copied {lines} line{'s' if lines > 1 else ''}. {self.app.clipboard_hint}".strip(),
            timeout=2.5,
            markup=False,
        )

    def copy_output(self, argument: str = "") -> None:
        """Copy the whole output."""
        del argument
        self.copy(self.app.command.console.text)

    def copy_graph(self, argument: str = "") -> None:
        """Copy the last run's samples, tab-separated."""
        del argument
        if self.app.session.runs:
            table = StringIO()
            self.app.write_samples(table, delimiter="\t")
            self.copy(table.getvalue())
        else:
            self.app.notify("No run yet: press F5.", timeout=2)

    def palette(self, argument: str = "") -> None:
        """Open the command palette."""
        del argument
        self.app.action_command_palette()
