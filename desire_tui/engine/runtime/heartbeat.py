"""Brings a long block of native code back now and then, although no sample is due.

A run with few samples may stay in native code for seconds. Then nobody would see t move, and a back end that
has compiled faster code meanwhile could not change over. The stop flag brings it back; if the user
wants nothing, it goes on.
"""

from __future__ import annotations

import threading
from time import sleep
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from desire_tui.engine.runtime.pause_and_stop import Control

BEAT_SECONDS = 0.05
_WAIT_SECONDS = 2.0
"""How long the thread outlives the last run: the next one of a loop need not start it again."""


class Heartbeat:
    """Brings back blocks of one session that last longer than a beat."""

    def __init__(self, control: Control) -> None:
        self._control = control
        self._blocks = 0

    def begin(self) -> None:
        """Note that a run begins."""
        _beats.begin(self)

    def block(self) -> None:
        """Note that a block begins."""
        self._blocks += 1

    def end(self) -> None:
        """Note that the run is over."""
        _beats.end(self)

    @property
    def blocks(self) -> int:
        """How many blocks have begun."""
        return self._blocks

    def bring_back(self) -> None:
        """End the block under way early."""
        self._control.interrupt_block()


class _Beats:
    """The one thread of the process that watches all runs; there is none when nothing has run for a while."""

    def __init__(self) -> None:
        self._running: set[Heartbeat] = set()
        self._changed = threading.Condition()
        self._thread: threading.Thread | None = None

    def begin(self, heartbeat: Heartbeat) -> None:
        with self._changed:
            self._running.add(heartbeat)
            if self._thread is None or not self._thread.is_alive():
                self._thread = threading.Thread(target=self._beat, daemon=True, name="desire-heartbeat")
                self._thread.start()
            self._changed.notify()

    def end(self, heartbeat: Heartbeat) -> None:
        with self._changed:
            self._running.discard(heartbeat)

    def _beat(self) -> None:
        while True:
            with self._changed:
                if not self._changed.wait_for(lambda: self._running, _WAIT_SECONDS):
                    self._thread = None
                    return
                seen = [(heartbeat, heartbeat.blocks) for heartbeat in self._running]
            sleep(BEAT_SECONDS)
            with self._changed:
                for heartbeat, blocks in seen:
                    if heartbeat in self._running and heartbeat.blocks == blocks:
                        heartbeat.bring_back()
            del seen


_beats = _Beats()
