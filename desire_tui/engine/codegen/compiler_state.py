"""What native back ends share: compiled code, and the threads that make it until the process ends."""

from __future__ import annotations

import atexit
import functools
import threading
from contextlib import suppress
from typing import TYPE_CHECKING

from desire_tui.engine.codegen.jit import llvm_turn
from desire_tui.engine.codegen.jit.background import Improver
from desire_tui.engine.codegen.jit.cache import CodeCache
from desire_tui.engine.codegen.jit.target_machine import load_llvm
from desire_tui.engine.codegen.loop.compiled_loops import array_loop
from desire_tui.engine.integration.rules import MOST_USED_FIRST

if TYPE_CHECKING:
    from desire_tui.engine.codegen.stiff.solver_routines import SolverRoutines

_ABANDONED_SECONDS = 30.0
"""For a compilation that nobody waits for any more."""
_MAKING = threading.Lock()


class CompilerState:
    """One for all sessions of a process (`shared_state`): code depends on nothing but its text.

    A session that is to share nothing may own one; who makes it closes it. LLVM itself and its symbols
    (`jit.target_machine`) are always the process's. `keep`: what is compiled is kept on disk, and found
    there.
    """

    def __init__(self, *, keep: bool = False) -> None:
        self.code = CodeCache(keep=keep)
        self.improver = Improver()
        self._routines: SolverRoutines | None = None
        self._lock = threading.Lock()
        self._ending = threading.Event()
        atexit.register(self.close)

    @property
    def routines(self) -> SolverRoutines:
        """Return the native solver of rules 9 … 16, whose modules are imported by the first who wants it."""
        from desire_tui.engine.codegen.stiff.solver_routines import SolverRoutines

        with self._lock:
            if self._routines is None:
                self._routines = SolverRoutines()
            return self._routines

    def close(self) -> None:
        """End the threads, LLVM's work under way first: its memory goes with the process."""
        atexit.unregister(self.close)
        self._ending.set()
        self.improver.close()
        llvm_turn.wait(_ABANDONED_SECONDS)

    def prepare_loops(self) -> None:
        """Load LLVM, compile every rule's loop, so that the next program need not: where more will be run."""
        with suppress(Exception):  # the engine meets the same fault when it compiles, and reports it there
            load_llvm()
        for rule in MOST_USED_FIRST:
            if self._ending.is_set():
                return
            self.code.quick([array_loop(rule, contiguous=True)])


def shared_state() -> CompilerState:
    """Return the state that sessions share."""
    with _MAKING:
        return _shared_state()


@functools.cache
def _shared_state() -> CompilerState:
    return CompilerState(keep=True)
