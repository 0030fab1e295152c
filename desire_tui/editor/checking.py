"""Problems while typing: programs are checked in a thread of their own, only the newest text of each tab."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING

from desire_tui.engine.source import Source

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.editor.buffer import Buffer
    from desire_tui.engine.diagnostics import Diagnostic

    Report = Callable[[int, int, "tuple[Diagnostic, ...]"], None]
    Check = Callable[[Source], "tuple[Diagnostic, ...]"]

CHECKED_MAX = 2_000_000
"""Longer texts are not checked while typing (characters)."""


class Checker:
    """Checks texts one after the other.

    `report(tab number, version, problems)` is called in the checking thread.
    """

    def __init__(self, check: Check, report: Report, fault: Callable[[Exception], object]) -> None:
        self._check = check
        self._report = report
        self._fault = fault
        self._wanted: dict[int, tuple[int, Source]] = {}
        self._news = threading.Condition()
        self._thread: threading.Thread | None = None

    def ask(self, buffer: Buffer, version: int, text: str) -> None:
        """Check a text when its turn comes; an older text of the same tab is forgotten."""
        if len(text) > CHECKED_MAX:
            return
        with self._news:
            self._wanted[buffer.number] = (version, Source(text, buffer.name, buffer.path))
            self._news.notify()
        if self._thread is None:
            self._thread = threading.Thread(target=self._work, daemon=True, name="desire-check")
            self._thread.start()

    def _work(self) -> None:
        while True:
            with self._news:
                while not self._wanted:
                    self._news.wait()
                number = next(iter(self._wanted))
                version, source = self._wanted.pop(number)
            try:
                problems = self._check(source)
            except Exception as error:  # noqa: BLE001 - a fault in a check must not end all checking
                self._fault(error)
            else:
                self._report(number, version, problems)
