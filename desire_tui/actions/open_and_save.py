"""Opening and saving programs; which files are meant."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from desire_tui.actions import Controller
from desire_tui.actions.foreign_models import converted
from desire_tui.actions.save_and_reload import SaveAndReload
from desire_tui.common.dialogs import LineDialog
from desire_tui.common.paths import exists, full
from desire_tui.common.recent_files import note_recent, recent_files
from desire_tui.editor import line_ends
from desire_tui.editor.buffer import Buffer, NotText

if TYPE_CHECKING:
    from desire_tui.app import DesireApp
    from desire_tui.editor.code_area import CodeArea
    from desire_tui.editor.program_lines import ProgramLines

SUFFIX = ".src"
_NAMED_MOST = 40


def numbered(document: ProgramLines) -> str:
    """Return a program with line numbers, by tens, and the line ends of its file: `edit` and `keep+`."""
    from desire_tui.engine.syntax.line_numbers import with_numbers

    *lines, _ = with_numbers(document.text).split("\n")
    ends = [end or document.usual_end for end in document.ends][: len(lines)]
    return line_ends.ended([*lines, ""], [*ends, ""])


class OpenAndSave(Controller):
    """The half of part `file` of the command table that reads and writes files."""

    def __init__(self, app: DesireApp) -> None:
        super().__init__(app)
        self.save_and_reload = SaveAndReload(app)

    # ------------------------------------------------------------------------------------------------- open

    async def open(self, argument: str = "") -> None:
        """Open a file, asking which if none is named."""
        from_prompt = self.app.command.prompt.has_focus
        path = self._resolve(argument) if argument else await self._pick()
        if path is None or (self._is_foreign(path) and await converted(self.app, path)):
            return
        await self.open_path(path, focus=not from_prompt)

    def _is_foreign(self, path: Path) -> bool:
        from desire_tui.convert.conversion import is_convertible

        return is_convertible(path.name) and exists(path) and self.app.may_read(path)

    async def _pick(self) -> Path | None:
        if self.app.reach.folder is not None:  # a dialog that shows every folder is not for visitors
            return await self._ask_within("Open", "")
        from desire_tui.common.file_dialog import FileDialog

        dialog = FileDialog(self._folder(), SUFFIX, recent=recent_files())
        return await self.app.push_screen_wait(dialog)

    async def open_path(self, path: Path, *, focus: bool = True) -> CodeArea | None:
        """Open a file in a tab, or show the tab that holds it.

        None where it cannot be read; the user is told.
        """
        path = full(path)
        editor = self.app.editor
        if not self.app.may_read(path):
            return None
        if (known := next((a for a in editor.areas if a.buffer.path == path), None)) is not None:
            editor.show(known, focus=focus)
            return known
        try:
            buffer = Buffer.from_file(path)
        except (OSError, NotText) as error:
            reason = error.strerror if isinstance(error, OSError) else str(error)
            self.app.report_error(f"cannot open {path}: {reason}", code=18 if exists(path) else 38)
            return None
        self._note_recent(path)
        area = await editor.add(buffer)
        if focus:
            self.app.move_focus(area)
        return area

    def _note_recent(self, path: Path) -> None:
        if self.app.reach.folder is None:  # one visitor's files are not the next one's
            note_recent(path)

    def _folder(self) -> Path:
        path = self.app.editor.front.buffer.path
        return path.parent if path else Path.cwd()

    def _resolve(self, name: str) -> Path | None:
        if not self.app.is_file_name(name):
            return None
        path = Path(os.path.expanduser(name))  # noqa: PTH111 - ~nobody is no error
        if not path.suffix and not exists(self._folder() / path):
            path = path.with_suffix(SUFFIX)
        here = self._folder() / path
        return here if exists(here) or not exists(Path.cwd() / path) else Path.cwd() / path

    # ------------------------------------------------------------------------------------------------- save

    async def save(self, argument: str = "") -> None:
        """`keep`: save over the tab's file, or as `argument`."""
        area = self.app.editor.front
        await (
            self.save_area(area, self._resolve(argument))
            if argument
            else self.save_area(area, area.buffer.path)
        )

    async def save_as(self, argument: str = "") -> None:
        """Save under a name that is asked for."""
        area = self.app.editor.front
        await self.save_area(area, self._resolve(argument) if argument else None)

    async def save_numbered(self, argument: str = "") -> None:
        """`keep+`: save with line numbers; the tab keeps its text."""
        area = self.app.editor.front
        path = self._resolve(argument) if argument else area.buffer.path or await self._ask_path(area)
        if path is not None and await self.save_and_reload.may_overwrite(area, path):
            await self.save_and_reload.write(path, numbered(area.document), area.buffer.encoding)

    async def save_area(self, area: CodeArea, path: Path | None) -> bool:
        """Save a tab; asks for a name if there is none, and before others' work is overwritten."""
        path = path or await self._ask_path(area)
        if path is None or not await self.save_and_reload.may_overwrite(area, path):
            return False
        text = area.document.ended_text
        encoding = await self.save_and_reload.write(path, text, area.buffer.encoding)
        if encoding is None:
            return False
        area.buffer.hold(full(path), text, encoding)
        self._note_recent(full(path))
        self.app.editor.kind_changed(area)
        self.app.notify(f"Saved {path}", timeout=2, markup=False)
        return True

    async def _ask_path(self, area: CodeArea) -> Path | None:
        if self.app.reach.folder is not None:
            return await self._ask_within("Save as", area.buffer.name.removesuffix(SUFFIX) + SUFFIX)
        from desire_tui.common.file_dialog import FileDialog

        name = area.buffer.name if Path(area.buffer.name).suffix else area.buffer.name + SUFFIX
        return await self.app.push_screen_wait(FileDialog(self._folder(), SUFFIX, name=name))

    async def _ask_within(self, title: str, value: str) -> Path | None:
        """Ask for a file of the folder that is served."""
        programs = sorted(
            path.name for path in self._folder().glob(f"*{SUFFIX}") if self.app.reach.may_read(path)
        )
        hint = ", ".join(programs[:_NAMED_MOST]) + (" …" if len(programs) > _NAMED_MOST else "")
        name = await self.app.push_screen_wait(LineDialog(title, value, hint or "a file of this folder"))
        return self._resolve(name) if name else None

    async def ask_name(self, title: str, value: str) -> str | None:
        """Ask for a file name."""
        return await self.app.push_screen_wait(
            LineDialog(title, value, "relative names start at the program's folder")
        )
