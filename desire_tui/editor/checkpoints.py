"""Keeps the editors' work safe.

Checkpoints while the app runs, the session file at the end, recovery at the start.
"""

from __future__ import annotations

import threading
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING

from desire_tui.common.paths import can_name_a_file
from desire_tui.editor import recovery
from desire_tui.editor.buffer import Buffer, NotText
from desire_tui.editor.recovery import Leftover, SavedTab
from desire_tui.engine.text_encoding import ENCODINGS

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.editor.code_area import CodeArea
    from desire_tui.editor.editor_pane import EditorPane

REST, REST_MOST_S = 10, 4.0
"""Texts of many MB are written less often: so many times as long as it took passes until the next time."""


class Checkpoints:
    """One app's recovery file."""

    def __init__(self, editor: EditorPane) -> None:
        self._editor = editor
        self._last: list[SavedTab] = []
        self.failed = False
        self._writing = threading.Lock()
        self._begin_at = 0.0

    def checkpoint(self) -> bool:
        """Write unsaved work if it changed. Returns False the first time the folder cannot be written."""
        dirty = self._dirty()
        with self._writing:
            return self._write(dirty)

    def begin(self, failed: Callable[[], object]) -> None:
        """Do the same in a thread, where it holds up no key; never for more than a tenth of the time."""
        dirty = self._dirty()
        if dirty == self._last or monotonic() < self._begin_at or not self._writing.acquire(blocking=False):
            return

        def write() -> None:
            start = monotonic()
            try:
                is_kept = self._write(dirty)
            finally:
                self._begin_at = monotonic() + min(REST * (monotonic() - start), REST_MOST_S)
                self._writing.release()
            if not is_kept:
                failed()

        threading.Thread(target=write, daemon=True, name="desire-checkpoint").start()

    def _dirty(self) -> list[SavedTab]:
        return [self._saved(area) for area in self._editor.areas if area.is_dirty]

    def _write(self, dirty: list[SavedTab]) -> bool:
        if dirty == self._last:
            return True
        if recovery.store(recovery.recovery_file(), dirty):
            self._last = dirty
            return True
        first, self.failed = not self.failed, True
        return not first

    def _saved(self, area: CodeArea, *, text: bool = True) -> SavedTab:
        buffer = area.buffer
        row, column = area.cursor_location
        return SavedTab(
            str(buffer.path) if buffer.path else None, buffer.label or buffer.name,
            area.document.ended_text if text else None,
            row, column, area is self._editor.front.tab, buffer.encoding.name, buffer.stamp,
        )  # fmt: skip

    def leave(self) -> None:
        """End well: remember which files were open, remove the recovery file."""
        tabs = [self._saved(area, text=False) for area in self._editor.areas if area.buffer.path]
        recovery.store(recovery.session_file(), tabs, sync=False)  # no work is in it, and somebody waits
        with self._writing:
            recovery.recovery_file().unlink(missing_ok=True)

    async def adopt(self, leftover: Leftover) -> int:
        """Open the tabs of a session that ended badly; returns how many."""
        for tab in leftover.tabs:
            if tab.text is None:
                continue
            buffer = _buffer_of(tab)
            area = await self._editor.add(buffer, tab.text)
            area.go_to(tab.row, tab.column)
        self._last = []
        self.checkpoint()
        leftover.file.unlink(missing_ok=True)
        return len(leftover.tabs)

    async def restore(self) -> bool:
        """Open the files of the last session; False if there are none."""
        try:
            tabs = recovery.read(recovery.session_file())
        except (OSError, ValueError):
            return False
        front: CodeArea | None = None
        opened = False
        for tab in tabs:
            try:
                buffer = Buffer.from_file(Path(tab.path or ""))
            except (OSError, NotText):
                continue
            area = await self._editor.add(buffer)
            area.go_to(tab.row, tab.column)
            front = area if tab.front else front
            opened = True
        if front is not None:
            self._editor.show(front)
        return opened


def _buffer_of(tab: SavedTab) -> Buffer:
    if tab.path is None or not can_name_a_file(tab.path):
        buffer = Buffer(label=tab.label)
    else:
        try:
            buffer = Buffer.from_file(Path(tab.path))
        except (OSError, NotText):
            buffer = Buffer(Path(tab.path))
        else:
            buffer.stamp = tab.stamp if tab.stamp is not None else buffer.stamp
    if tab.encoding is not None:
        buffer.encoding = ENCODINGS[tab.encoding]
    return buffer
