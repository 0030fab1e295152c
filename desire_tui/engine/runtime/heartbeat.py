"""Brings a long block of native code back now and then, although no sample is due.

A run with few samples may stay in native code for seconds. Then nobody would see t move, and a back end that
has compiled faster code meanwhile could not change over. The stop flag brings it back; with no wish there, it
goes on.
"""

from __future__ import annotations

import threading
import weakref
from time import sleep
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from desire_tui.engine.runtime.pause_and_stop import Control

TICK_SECONDS = 0.05
_LOOK_SECONDS = 2.0  # how long the thread outlives its session


class Ticker:
    """Nudges a control while blocks last longer than a tick. Its one thread sleeps between runs."""

    def __init__(self, control: Control) -> None:
        self._control = weakref.ref(control)
        self._running = threading.Event()
        self._blocks = 0
        self._thread: threading.Thread | None = None

    def begin(self) -> None:
        """Hear that a run begins."""
        if self._thread is None or not self._thread.is_alive():
            self._thread = threading.Thread(
                target=_tick, args=(weakref.ref(self),), daemon=True, name="desire-ticker"
            )
            self._thread.start()
        self._running.set()

    def block(self) -> None:
        """Hear that a block begins."""
        self._blocks += 1

    def end(self) -> None:
        """Hear that the run is over."""
        self._running.clear()

    def tick(self) -> bool:
        """Nudge if the block has not changed for a tick; False: the session is gone."""
        if self._running.wait(_LOOK_SECONDS):
            seen = self._blocks
            sleep(TICK_SECONDS)
            control = self._control()
            if control is None:
                return False
            if self._running.is_set() and self._blocks == seen:
                control.nudge()
        return True


def _tick(reference: weakref.ref[Ticker]) -> None:
    while True:
        ticker = reference()
        if ticker is None or not ticker.tick():
            return
        del ticker
