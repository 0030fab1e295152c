"""Ctrl-C while the engine works in the caller's thread: it ends the work, then raises KeyboardInterrupt.

Python raises KeyboardInterrupt between any two instructions, and so behind a lock that was just taken: the
next run would wait for it for ever. Here the signal is noted, whatever goes on is told to end, and the
exception comes when everything has been left in order. A second Ctrl-C is raised at once.
"""

from __future__ import annotations

import signal
import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Self

if TYPE_CHECKING:
    from collections.abc import Iterator

    from desire_tui.engine.runtime.pause_and_stop import Control

_now: list[Interrupts] = []
"""Those of the main thread, the innermost last."""


class Interrupts:
    """Context of a call that may take long. Callers with a handler of their own for SIGINT keep it."""

    def __init__(self) -> None:
        self.came = False
        self._controls: list[Control] = []
        self._before: Any = None
        self._may_raise = False

    def __enter__(self) -> Self:
        """Note signals from now on, in the main thread."""
        is_main = threading.current_thread() is threading.main_thread()
        if is_main and signal.getsignal(signal.SIGINT) is signal.default_int_handler:
            self._before = signal.signal(signal.SIGINT, self._note)
            _now.append(self)
        return self

    def __exit__(self, *_: object) -> None:
        """Raise KeyboardInterrupt if there was one."""
        if self._before is not None:
            _now.remove(self)
            signal.signal(signal.SIGINT, self._before)
            for control in self._controls:
                control.spare()
        if self.came:
            raise KeyboardInterrupt from None

    def _note(self, number: int, frame: Any) -> None:
        if self.came or self._may_raise:
            signal.default_int_handler(number, frame)
        self.came = True
        for control in self._controls:
            control.doom()

    def watch(self, control: Control) -> None:
        """Name what is to end when a signal comes, or at once if one has come."""
        self._controls.append(control)
        if self.came:
            control.doom()

    @contextmanager
    def raising(self) -> Iterator[None]:
        """Let the signal raise at once, in code of the caller's."""
        before, self._may_raise = self._may_raise, True
        try:
            yield
        finally:
            self._may_raise = before


def watch(control: Control) -> None:
    """Let Ctrl-C end what goes on under a control, if this thread hears of it."""
    if _now and threading.current_thread() is threading.main_thread():
        _now[-1].watch(control)


@contextmanager
def callers_code() -> Iterator[None]:
    """Run code of the caller's, such as a callback: Ctrl-C is raised in it."""
    if _now and threading.current_thread() is threading.main_thread():
        with _now[-1].raising():
            yield
    else:
        yield
