"""Brings a long block of native code back now and then, although no sample is due.

A run with few samples may stay in native code for seconds. Then nobody would see t move, and a back end that
has compiled faster code meanwhile could not change over. The stop flag brings it back; if the user
wants nothing, it goes on.
"""

from __future__ import annotations

import threading
import weakref
from time import sleep
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from desire_tui.engine.runtime.pause_and_stop import Control

BEAT_SECONDS = 0.05
_WAIT_SECONDS = 2.0  # how long the thread outlives its session


class Heartbeat:
    """Brings back blocks that last longer than a beat. Its one thread sleeps between runs."""

    def __init__(self, control: Control) -> None:
        self._control = weakref.ref(control)
        self._running = threading.Event()
        self._blocks = 0
        self._thread: threading.Thread | None = None

    def begin(self) -> None:
        """Note that a run begins."""
        if self._thread is None or not self._thread.is_alive():
            self._thread = threading.Thread(
                target=_beat_until_gone, args=(weakref.ref(self),), daemon=True, name="desire-heartbeat"
            )
            self._thread.start()
        self._running.set()

    def block(self) -> None:
        """Note that a block begins."""
        self._blocks += 1

    def end(self) -> None:
        """Note that the run is over."""
        self._running.clear()

    def beat(self) -> bool:
        """Bring the block back if it has lasted for a beat; False: the session is gone."""
        if self._running.wait(_WAIT_SECONDS):
            seen = self._blocks
            sleep(BEAT_SECONDS)
            control = self._control()
            if control is None:
                return False
            if self._running.is_set() and self._blocks == seen:
                control.interrupt_block()
        return True


def _beat_until_gone(reference: weakref.ref[Heartbeat]) -> None:
    while True:
        heartbeat = reference()
        if heartbeat is None or not heartbeat.beat():
            return
        del heartbeat
