"""Problems while typing: programs are checked in a thread of their own, only the newest text of each.

A quick check follows each key; a closer look waits until nobody types.
"""

from __future__ import annotations

import threading
from functools import partial
from typing import TYPE_CHECKING, Protocol

from desire_tui.engine.cancellation import cancellable
from desire_tui.engine.source import Source, Span

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from desire_tui.engine.diagnostics import Diagnostic

    Report = Callable[[int, int, "tuple[Diagnostic, ...]"], None]
    Check = Callable[[Source], "tuple[Diagnostic, ...]"]
    Checked = tuple[int, Source, "tuple[Diagnostic, ...]"]

CHECKED_MAX = 2_000_000
"""Longer texts are not checked while typing (characters): Python and the editor copy them at each key."""
QUIET_SECONDS = 0.5
"""Nobody has typed for so long: time for a closer look."""


class Edited(Protocol):
    """A text that is being edited; `number` tells it from the others."""

    @property
    def number(self) -> int:
        """What nothing else that is checked has."""

    @property
    def name(self) -> str:
        """What messages call it."""

    @property
    def path(self) -> Path | None:
        """Its file, if it has one."""


class LiveChecker:
    """Checks texts one after the other.

    `report(number, version, problems)` is called in the checking thread; once more if `look_closer`
    finds something else than `check` did.
    """

    def __init__(
        self,
        check: Check,
        report: Report,
        fault: Callable[[BaseException], object],
        look_closer: Check | None = None,
    ) -> None:
        self._check, self._look_closer = check, look_closer
        self._report = report
        self._fault = fault
        self._wanted: dict[int, tuple[int, Source]] = {}
        self._checked: dict[int, Checked] = {}  # waiting for a closer look
        self._ended = False
        self._condition = threading.Condition()
        self._thread: threading.Thread | None = None

    def end(self) -> None:
        """Check nothing more; what is being checked is reported."""
        with self._condition:
            self._ended = True
            self._condition.notify()

    def ask(self, buffer: Edited, version: int, text: str) -> None:
        """Check a text when its turn comes; an older one of the same number is forgotten, or broken off."""
        with self._condition:
            self._wanted[buffer.number] = (version, Source(text, buffer.name, buffer.path))
            self._condition.notify()
        if self._ended:
            return
        if self._thread is None or not self._thread.is_alive():  # at first, or something ended it
            self._thread = threading.Thread(target=self._work, daemon=True, name="desire-check")
            self._thread.start()

    def _work(self) -> None:
        while True:
            wanted = self._next_wanted()
            if self._ended:
                return
            try:
                if wanted is None:
                    self._closer()
                else:
                    self._quickly(*wanted)
            except _Superseded:
                pass
            except BaseException as error:  # noqa: BLE001 - a fault in a check must not end all checking
                self._fault(error)

    def _next_wanted(self) -> tuple[int, int, Source] | None:
        """Wait for a text; None: it is quiet, and some are waiting for a closer look, or all is over."""
        with self._condition:
            patience = QUIET_SECONDS if self._checked else None
            self._condition.wait_for(lambda: self._wanted or self._ended, patience)
            if not self._wanted:
                return None
            number = next(iter(self._wanted))
            return number, *self._wanted.pop(number)

    def _quickly(self, number: int, version: int, source: Source) -> None:
        self._checked.pop(number, None)
        if len(source.text) > CHECKED_MAX:
            self._report(number, version, (_too_long(source),))
            return
        with cancellable(partial(self._give_way, number)):
            problems = self._check(source)
        if self._look_closer is not None:
            self._checked[number] = (version, source, problems)
        self._report(number, version, problems)

    def _closer(self) -> None:
        number = next(iter(self._checked))
        version, source, known = self._checked.pop(number)
        assert self._look_closer is not None
        with cancellable(partial(self._give_way, number)):
            problems = self._look_closer(source)
        if problems != known:
            self._report(number, version, problems)

    def _give_way(self, number: int) -> None:
        """Leave a text of which there is a newer one."""
        if number in self._wanted:
            raise _Superseded


class _Superseded(Exception):  # noqa: N818 - nothing is wrong
    """The text that is being checked was edited."""


def _too_long(source: Source) -> Diagnostic:
    from desire_tui.engine.diagnostics import Diagnostic

    return Diagnostic("check-too-long", Span(0, 0), {"most": CHECKED_MAX}, source, "warning")
