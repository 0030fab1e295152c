"""Files and tabs."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from desire_tui.actions.open_and_save import OpenAndSave, numbered
from desire_tui.common.dialogs import Choice
from desire_tui.editor.buffer import Buffer

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.editor.code_area import CodeArea
    from desire_tui.editor.program_lines import ProgramLines


class FileActions(OpenAndSave):
    """Part `file` of the command table."""

    # -------------------------------------------------------------------------------------------------- new

    async def new(self, argument: str = "") -> None:
        """Open an empty tab."""
        del argument
        area = await self.app.editor.add(Buffer())
        self.app.move_focus(area)

    async def clear(self, argument: str = "") -> None:
        """Clear the program after asking (`new`)."""
        answer = await self.app.push_screen_wait(
            Choice("New program", "Clear the program and all quantities?", ("Yes", "No"))
        )
        if answer == "Yes":
            await self.clear_now(argument)

    async def clear_now(self, argument: str = "") -> None:
        """Clear at once (`NEW`): an empty tab, no names, scale 1, irule 1."""
        del argument
        self.app.run_actions.end_now()
        self.app.engine.submit(self.app.session.new)
        area = await self.app.editor.add(Buffer())
        self.app.editor.active = None
        self.app.editor.show(area, focus=True)

    # ------------------------------------------------------------------------------------- reload and copies

    async def reload(self, argument: str = "") -> None:
        """`reload`: the last-saved text of the front tab."""
        del argument
        area = self.app.editor.front
        if area.buffer.path is None:
            self.app.report_error("this tab was never saved: there is nothing to reload", code=18)
            return
        if area.is_dirty:
            sentence = f"Give up the changes in {area.buffer.name}?"
            if await self.app.push_screen_wait(Choice("Reload", sentence, ("Reload", "Cancel"))) != "Reload":
                return
        self.save_and_reload.read_again(area)

    async def edit_copy(self, argument: str = "") -> None:
        """`ed`: a copy of the active program in a new tab."""
        del argument
        await self._copy(lambda document: document.ended_text)

    async def edit_numbered(self, argument: str = "") -> None:
        """`edit`: the same with line numbers."""
        del argument
        await self._copy(numbered)

    async def _copy(self, change: Callable[[ProgramLines], str]) -> None:
        origin = self.app.editor.active or self.app.editor.front
        buffer = Buffer(label=f"{Path(origin.buffer.name).stem}-copy", encoding=origin.buffer.encoding)
        area = await self.app.editor.add(buffer, change(origin.document))
        self.app.move_focus(area)

    # ------------------------------------------------------------------------------------------ tabs, leaving

    async def close(self, argument: str = "") -> None:
        """Close the front tab; asks where work would go."""
        del argument
        area = self.app.editor.front
        if await self.may_lose(area):
            await self.app.editor.close_tab(area)

    async def may_lose(self, area: CodeArea) -> bool:
        """Whether a tab may go: it is saved, or the user saves it now or gives it up."""
        if not area.is_dirty:
            return True
        self.app.editor.show(area)
        choice = await self.app.push_screen_wait(
            Choice(
                "Unsaved work",
                f"{area.buffer.name} has changes that are not saved.",
                ("Save", "Discard", "Cancel"),
            )
        )
        return await self.save_area(area, area.buffer.path) if choice == "Save" else choice == "Discard"

    def next(self, argument: str = "") -> None:
        """Show the next tab."""
        del argument
        self.app.editor.step(1)

    def previous(self, argument: str = "") -> None:
        """Show the tab before."""
        del argument
        self.app.editor.step(-1)

    def move_left(self, argument: str = "") -> None:
        """Move the front tab one place to the left."""
        del argument
        self._move(-1)

    def move_right(self, argument: str = "") -> None:
        """Move the front tab one place to the right."""
        del argument
        self._move(1)

    def _move(self, by: int) -> None:
        editor = self.app.editor
        editor.move_tab(editor.front, editor.areas.index(editor.front.tab) + by)

    async def split(self, argument: str = "") -> None:
        """Show two tabs side by side, or one."""
        del argument
        await self.app.editor.split()

    async def twice(self, argument: str = "") -> None:
        """Show the front tab twice, or once."""
        del argument
        await self.app.editor.show_twice()

    async def quit(self, argument: str = "") -> None:
        """Leave; asks about each tab with unsaved work."""
        del argument
        for area in list(self.app.editor.areas):
            if not await self.may_lose(area):
                return
        self.app.leave()

    # ----------------------------------------------------------------------------------------------- others

    def external(self, argument: str = "") -> None:
        """Edit the front tab in $EDITOR."""
        del argument
        from desire_tui.editor.external_editor import edit_outside

        edit_outside(self.app, self.app.editor.front)

    async def examples(self, argument: str = "") -> None:
        """Browse the examples."""
        del argument
        from desire_tui.panes.examples_browser import ExamplesScreen

        chosen = await self.app.push_screen_wait(ExamplesScreen())
        if chosen is None:
            return
        await self.open_example(chosen.example.path, chosen.example.text)
        self.app.command.prompt.focus()
        if chosen.run:
            self.app.do("run.start")

    async def open_example(self, path: Path, text: str) -> None:
        """Open a copy of an example, so that saving it never changes the original.

        An untouched copy that is open already comes to the front.
        """
        editor = self.app.editor
        known = (a for a in editor.areas if a.buffer.name == path.name and a.text == text)
        if (area := next(known, None)) is not None:
            editor.show(area)
            return
        blank = editor.front.tab if not editor.front.text and editor.front.buffer.path is None else None
        await editor.add(Buffer(label=path.name, saved_text=text, ended_text=text))
        if blank is not None and blank is not editor.active:
            await editor.close_tab(blank)
