"""The process's pool of threads for large models: started by the first of them, ended with the process."""

from __future__ import annotations

import atexit
import ctypes
import os
import threading
from typing import TYPE_CHECKING

from desire_tui.engine.codegen.jit.compiler import compile_and_keep, kept_code, machine, module_text
from desire_tui.engine.codegen.threads.pool_code import MEMBERS_MOST, pool_text
from desire_tui.engine.digest import blake2b
from desire_tui.engine.thread_count import thread_count, when_it_changes

if TYPE_CHECKING:
    from desire_tui.engine.codegen.jit.machine_code import MachineCode

_END_SECONDS = 1.0
_ONE_NUMBER = ctypes.CFUNCTYPE(None, ctypes.c_int64)
_NOTHING = ctypes.CFUNCTYPE(None)
_lock = threading.Lock()
_pool: ThreadPool | None = None


class ThreadPool:
    """Threads that wait in native code, the interpreter's lock released, for loops to share.

    The thread that runs a model is a member, so there is one thread less than `members`.
    """

    def __init__(self, members: int) -> None:
        self._code = _native_code()
        self._threads: list[threading.Thread] = []
        self._changing = threading.Lock()
        self._open(members)

    @property
    def members(self) -> int:
        """How many threads share a loop, the one that runs the model among them."""
        return len(self._threads) + 1

    @property
    def share(self) -> int:
        """Address of `pool.share` (`pool_code`); it stays the same."""
        return self._code.address("pool.share")

    def resize(self, members: int) -> None:
        """Have other threads; a loop that is going on is waited for."""
        with self._changing:
            _NOTHING(self._code.address("pool.claim"))()
            self.close()
            self._open(members)

    def fit(self) -> None:
        """Have as many threads as a run may have now."""
        if thread_count() != self.members:
            self.resize(thread_count())

    def after_fork(self) -> None:
        """Go on without threads in a child process: none of them is there."""
        self._threads = []
        _ONE_NUMBER(self._code.address("pool.open"))(1)

    def close(self) -> None:
        """End the threads. A loop that is going on is done without them."""
        atexit.unregister(self.close)
        _NOTHING(self._code.address("pool.close"))()
        for thread in self._threads:
            thread.join(_END_SECONDS)
        self._threads = []

    def _open(self, members: int) -> None:
        members = min(members, MEMBERS_MOST)
        _ONE_NUMBER(self._code.address("pool.open"))(members)
        work = _ONE_NUMBER(self._code.address("pool.work"))
        for member in range(1, members):
            thread = threading.Thread(target=work, args=(member,), name=f"desire loop {member}", daemon=True)
            thread.start()
            self._threads.append(thread)
        atexit.register(self.close)


def thread_pool() -> ThreadPool:
    """Return the process's pool; the first call starts its threads."""
    global _pool  # noqa: PLW0603 - one for the process, and a fork must find it
    with _lock:
        if _pool is None:
            _pool = ThreadPool(thread_count())
            os.register_at_fork(after_in_child=_pool.after_fork)
            when_it_changes(_pool.fit)
        return _pool


def _native_code() -> MachineCode:
    functions, needs = pool_text(machine().triple)
    text = module_text(functions, needs)
    name = f"pool-{blake2b(text.encode(), digest_size=8).hexdigest()}"
    return kept_code(name) or compile_and_keep(text, name, level=2, vectorize=False)
