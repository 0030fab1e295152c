"""What stands on the disk and in the tabs: writing, reading again, changes made by somebody else."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.actions import Controller
from desire_tui.common.dialogs import Choice
from desire_tui.common.paths import exists, full
from desire_tui.editor.buffer import Buffer, NotText
from desire_tui.engine.atomic_file import replace_text
from desire_tui.engine.visible_text import visible_line

if TYPE_CHECKING:
    from pathlib import Path

    from desire_tui.editor.code_area import CodeArea


class SaveAndReload(Controller):
    """No part of the command table; the actions about files use it."""

    def write(self, path: Path, text: str) -> bool:
        """Write a file; False if it cannot be written, which the user is told."""
        if not self.app.may_write(path):
            return False
        try:
            replace_text(path, text)
        except OSError as error:
            self.app.report_error(f"cannot write {path}: {error.strerror}", code=106)
            return False
        return True

    async def may_overwrite(self, area: CodeArea, path: Path) -> bool:
        """Ask before others' work is overwritten by a tab's text."""
        if not self.app.may_write(path):
            return False
        own = area.buffer.path is not None and full(path) == area.buffer.path
        if own and area.buffer.changed_on_disk():
            sentence = f"{path.name} was changed on disk since it was read here."
            if not exists(path):
                return True  # it vanished: writing it again loses nothing
            choice = await self.app.push_screen_wait(
                Choice("Changed on disk", sentence, ("Overwrite", "Read it", "Cancel"), safe="Cancel")
            )
            if choice == "Read it":
                self.read_again(area)
            return choice == "Overwrite"
        if not own and exists(path):
            choice = await self.app.push_screen_wait(
                Choice(
                    "File exists",
                    f"{visible_line(str(path))} exists. Overwrite it?",
                    ("Overwrite", "Cancel"),
                    safe="Cancel",
                )
            )
            return choice == "Overwrite"
        return True

    def read_again(self, area: CodeArea) -> None:
        """Give a tab its file's text, as one undoable change."""
        buffer = area.buffer
        assert buffer.path is not None
        try:
            fresh = Buffer.from_file(buffer.path)
        except (OSError, NotText) as error:
            self.app.report_error(f"cannot read {buffer.path}: {error}", code=18)
            return
        row, column = area.cursor_location
        buffer.saved_text, buffer.stamp, buffer.crlf = fresh.saved_text, fresh.stamp, fresh.crlf
        if area.text != fresh.saved_text:
            area.rewrite_rows(0, area.document.line_count - 1, fresh.saved_text.split("\n"))
            area.go_to(row, column)
        self.app.editor.refresh_tabs()

    def notice_changes(self) -> None:
        """Read files that somebody else changed again where no unsaved work is lost; report the others."""
        for area in self.app.editor.areas:
            buffer = area.buffer
            if buffer.path is None or not buffer.changed_on_disk() or not exists(buffer.path):
                continue
            if not area.is_dirty:
                before = area.text
                self.read_again(area)
                if area.text != before:
                    self.app.notify(f"{buffer.name} changed on disk: read again.", markup=False, timeout=3)
            elif buffer.told_stamp != (now := buffer.stamp_on_disk()):
                buffer.told_stamp = now
                self.app.notify(
                    f"{buffer.name} was changed on disk, and has unsaved changes here.",
                    severity="warning", markup=False, timeout=5,
                )  # fmt: skip
