"""Pausing and ending what goes on, from another thread."""

from __future__ import annotations

from math import inf
from threading import Event, Lock
from time import monotonic
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from desire_tui.engine.runtime.run_memory import RunMemory


class Control:
    """What the user wants. `pause resume end` may be called from any thread, the rest from the working one.

    The order of the two writes in `pause` and of the two reads in `clear_to_run` matters: the request stands
    before the stop flag is raised, and is looked at after the flag was lowered, so that none is lost between
    two blocks.
    """

    def __init__(self) -> None:
        self._lock = Lock()
        self._go_on = Event()
        self._go_on.set()
        self._ending = self._doomed = False
        self._active = 0
        self._memory: RunMemory | None = None
        self.deadline = inf
        """When (`monotonic()`) the end of a run is requested without anybody's doing."""

    # ------------------------------------------------------------------ any thread

    @property
    def paused(self) -> bool:
        """Whether a pause is requested (the work may take some milliseconds to notice)."""
        return not self._go_on.is_set()

    @property
    def active(self) -> bool:
        """Whether anything goes on."""
        return self._active > 0

    def pause(self) -> None:
        """Request a pause, if anything goes on."""
        with self._lock:
            if self._active:
                self._go_on.clear()
                self._raise_flag()

    def resume(self) -> None:
        """Go on."""
        self._go_on.set()

    def end(self) -> None:
        """Request the end, if anything goes on."""
        with self._lock:
            if self._active:
                self._ending = True
                self._raise_flag()
        self._go_on.set()

    def doom(self) -> None:
        """End whatever goes on or begins, until `spare`. Takes no lock: signal handlers may call it."""
        self._doomed = True
        memory = self._memory
        if memory is not None:
            memory.stop = 1

    def spare(self) -> None:
        """Let work begin again."""
        self._doomed = False

    def interrupt_block(self) -> None:
        """Bring native code back for a moment; the run goes on unless the user wants something else."""
        with self._lock:
            self._raise_flag()

    def _raise_flag(self) -> None:
        if self._memory is not None:
            self._memory.stop = 1

    # ------------------------------------------------------------------ the working thread

    def begin(self) -> None:
        """Work begins: forget old requests. May nest."""
        with self._lock:
            if self._active == 0:
                self._ending = False
                self._go_on.set()
            self._active += 1

    def done(self) -> None:
        """Work is over."""
        with self._lock:
            self._active -= 1
            if self._active == 0:
                self._go_on.set()

    def attach(self, memory: RunMemory | None) -> None:
        """Name the memory whose stop flag is to be raised; None after the run."""
        with self._lock:
            self._memory = memory

    @property
    def ending(self) -> bool:
        """Whether the end is requested."""
        return self._ending or self._doomed

    def wait(self) -> bool:
        """Wait while paused; return whether work may go on."""
        self._go_on.wait()
        return not self.ending

    def clear_to_run(self, memory: RunMemory) -> bool:
        """Lower the stop flag; return False if a request came meanwhile and must be looked at first."""
        memory.stop = 0
        if self.deadline < inf and monotonic() > self.deadline:
            self.end()
        return self._go_on.is_set() and not self.ending
