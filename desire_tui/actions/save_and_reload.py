"""What stands on the disk and in the tabs: writing, reading again, changes made by somebody else."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.actions import Controller
from desire_tui.common.dialogs import Choice
from desire_tui.common.paths import config_file, exists, full
from desire_tui.editor.buffer import Buffer, NotText
from desire_tui.editor.line_ends import ends_of
from desire_tui.engine.atomic_file import replacing
from desire_tui.engine.source import Source
from desire_tui.engine.text_encoding import UTF_8, TextEncoding, encode, is_kept
from desire_tui.engine.user_folders import write_private
from desire_tui.engine.visible_text import visible_line

if TYPE_CHECKING:
    from pathlib import Path

    from desire_tui.editor.code_area import CodeArea


class SaveAndReload(Controller):
    """No part of the command table; the actions about files use it."""

    async def write(self, path: Path, text: str, encoding: TextEncoding) -> TextEncoding | None:
        """Write a file, in another encoding only if the user wants it; returns in which.

        None if it was not written, which the user knows.
        """
        if not self.app.may_write(path):
            return None
        reason = _why_not(text, encoding)
        if reason is not None and encoding != UTF_8 and _why_not(text, UTF_8) is None:
            sentence = f"{reason} Save {visible_line(path.name)} as UTF-8?"
            choice = Choice("Encoding", sentence, ("UTF-8", "Cancel"), safe="Cancel")
            if await self.app.push_screen_wait(choice) != "UTF-8":
                return None
            encoding, reason = UTF_8, None
        if reason is not None:
            self.app.report_error(f"cannot write {path}: {reason}", code=106)
            return None
        try:
            if full(path) == full(config_file()):
                write_private(str(full(path)), encode(text, encoding))
            else:
                with replacing(path, "wb", make_folder=True) as file:
                    file.write(encode(text, encoding))
        except OSError as error:
            self.app.report_error(f"cannot write {path}: {error.strerror}", code=106)
            return None
        return encoding

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
        buffer.hold(buffer.path, fresh.ended_text, fresh.encoding)
        buffer.stamp = fresh.stamp
        if area.text != fresh.saved_text:
            lines, ends = fresh.saved_text.split("\n"), ends_of(fresh.ended_text)
            area.rewrite_rows(0, area.document.line_count - 1, lines, ends)
            area.go_to(row, column)
        area.document.take_ends(fresh.ended_text)
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


def _why_not(text: str, encoding: TextEncoding) -> str | None:
    """Return why a text would not come back as it is from a file in an encoding."""
    try:
        data = encode(text, encoding)
    except UnicodeEncodeError as error:
        return _placed(text, error.start, f"which {encoding.name} does not have.")
    if is_kept(text, data) or (encoding == UTF_8 and "\0" not in text):
        return None  # a byte order mark typed in front is one afterwards
    if "\0" in text:
        return _placed(text, text.index("\0"), "which no text has.")
    return f"Written as {encoding.name}, these characters would be read as others."


def _placed(text: str, at: int, what: str) -> str:
    row, column = Source(text).position(at)
    return f"Line {row}, column {column} is {visible_line(text[at])} (U+{ord(text[at]):04X}), {what}"
