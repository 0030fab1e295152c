"""One thread that compiles fast code while quick code runs."""

from __future__ import annotations

import threading
import weakref
from contextlib import contextmanager, nullcontext
from time import perf_counter, process_time
from typing import TYPE_CHECKING, Protocol

from desire_tui.engine.codegen.jit.target_machine import LlvmNotLoadedError, loading_llvm

if TYPE_CHECKING:
    from collections.abc import Iterator
    from contextlib import AbstractContextManager

_BREATH_SECONDS = 0.0005
"""Between two steps, if one takes longer: LLVM's lock is not fair, and somebody may wait with quick code."""
_PATIENCE_SECONDS = 0.002
"""Of a model's runs, before its fast code is begun: shorter ones gain nothing from 15 ms of work."""
_PATIENCE_WITHOUT_LLVM_SECONDS = 0.015
"""If the code is not on disk and LLVM must be loaded first: 40 ms more, much of it in everybody's way."""
_WORTH_IT_SECONDS = 0.001
"""Of a model's runs, before they count for the next of its kind: to find fast code again takes 0.6 ms."""
_LOOK_SECONDS = 0.0005
"""At least, before looking again whether a run has lasted so long."""
_PAUSE_MOST_SECONDS = 0.016
"""Before looking again while runs are short: a thread that waits for Python's lock delays all others."""
_KINDS_MOST = 1000
_END_SECONDS = 30.0
_BEGUN_MOST = 3
_QUIET_SECONDS = 0.02
"""After somebody waited for quick code, more may follow; then the user comes first."""


_NOTHING_WAITS = nullcontext()


class Improvable(Protocol):
    """Something with fast code to come."""

    def improve(self) -> Iterator[None]:
        """Do the work, a step at a time."""
        ...


class Remembering(Improvable, Protocol):
    """Also says whether its fast code has come."""

    improved: bool


class Waiting:
    """Work whose model has not run for long, and for how long, in seconds of this process's processor time.

    While others have the processor, it does not run.
    """

    def __init__(self, work: Improvable) -> None:
        self.work = weakref.ref(work)
        self.may_load_llvm = False
        """Whether the work is worth that much; without it, it ends where it must."""
        self.has_run = False
        """Since the last look at it."""
        self._counted: tuple[float, float | None] = (0.0, None)
        """Runs that are over, and when this one began: one reference, which the other thread reads."""

    def follow(self, earlier: Waiting) -> None:
        """Count runs of an earlier model of the same kind, if they were worth fast code."""
        if earlier.seconds_over >= _WORTH_IT_SECONDS:
            self._counted, self.may_load_llvm = (earlier.seconds_over, None), earlier.may_load_llvm

    def begin(self, now: float) -> None:
        """Count from now on."""
        self._counted, self.has_run = (self._counted[0], now), True

    def end(self, now: float) -> None:
        """Count no further."""
        before, began = self._counted
        self._counted = (before if began is None else before + now - began, None)

    @property
    def patience(self) -> float:
        """For how long the model must have run."""
        return _PATIENCE_WITHOUT_LLVM_SECONDS if self.may_load_llvm else _PATIENCE_SECONDS

    @property
    def is_running(self) -> bool:
        """Whether the model runs."""
        return self._counted[1] is not None

    @property
    def was_long_enough(self) -> bool:
        """Whether the runs before this one were."""
        return self.seconds_over >= self.patience

    @property
    def seconds_over(self) -> float:
        """How long runs have lasted that are over."""
        return self._counted[0]

    def left(self) -> float:
        """Return how much longer the model must run, in seconds."""
        before, began = self._counted
        return self.patience - before - (process_time() - began if began is not None else 0.0)


class _Run:
    """A run of models that wait for fast code. Entered for each block of samples: no lock, no generator."""

    def __init__(self, improver: Improver, waiting: list[Waiting]) -> None:
        self._improver, self._waiting = improver, waiting

    def __enter__(self) -> None:
        now, due = process_time(), False
        for known in self._waiting:
            known.begin(now)
            due = due or known.was_long_enough
        if due or not self._improver.looks:
            self._improver.look(self._waiting)

    def __exit__(self, *_: object) -> None:
        now = process_time()
        for known in self._waiting:
            known.end(now)


class Improver:
    """Works through what it was given, the newest first; what nobody holds any more is dropped."""

    def __init__(self) -> None:
        self._waiting: list[Waiting] = []
        self._new: list[Waiting] = []
        self._begun: list[tuple[Waiting, Iterator[None]]] = []
        self._something = threading.Condition()
        self._thread: threading.Thread | None = None
        self._urgent = 0
        self._faults: list[Exception] = []
        self._over = False
        self.looks = False
        """Whether the thread looks at what waits without being woken, which costs more than a short run."""
        self._pause = _PATIENCE_SECONDS
        self._latest: dict[object, Waiting] = {}
        """The latest of each kind."""

    def add(self, work: Improvable) -> None:
        """Take up some work as soon as its model's runs have gone on for a moment (`running`).

        Runs of an earlier model of the same `kind` count too, if the work has one: a program that is run
        again is lowered anew.
        """
        waiting, kind = Waiting(work), getattr(work, "kind", None)
        with self._something:
            self._waiting = [known for known in self._waiting if known.work() is not None]
            self._waiting.append(waiting)
            if kind is not None:
                if kind in self._latest:
                    waiting.follow(self._latest.pop(kind))
                self._latest[kind] = waiting
                if len(self._latest) > _KINDS_MOST:
                    del self._latest[next(iter(self._latest))]

    def add_now(self, work: Improvable) -> None:
        """Take up some work at once."""
        with self._something:
            urgent = Waiting(work)
            urgent.may_load_llvm = True
            self._new.append(urgent)
            self._wake()

    def running(self, *works: Improvable) -> AbstractContextManager[None]:
        """Tell that the model runs to which these belong."""
        if not self._waiting:
            return _NOTHING_WAITS
        waiting = [known for known in self._waiting if known.work() in works]
        return _Run(self, waiting) if waiting else _NOTHING_WAITS

    def look(self, running: list[Waiting]) -> None:
        """Take up those that have run long enough before; look at the others when they may have."""
        with self._something:
            self._take([known for known in running if known.was_long_enough])
            self._wake()

    def again(self, work: Remembering) -> None:
        """Take up work that may have been dropped for newer work."""
        if work.improved:
            return
        with self._something:
            begun = [known for known, _ in self._begun]
            under_way = any(known.work() is work for known in (*begun, *self._new, *self._waiting))
        if not (under_way or work.improved):
            self.add(work)

    def faults(self) -> list[Exception]:
        """Return what went wrong since somebody asked: work that ended with an exception stays as it was."""
        with self._something:
            found, self._faults = self._faults, []
        return found

    @contextmanager
    def held(self) -> Iterator[None]:
        """Start no new step while somebody waits for quick code."""
        with self._something:
            self._urgent += 1
        try:
            yield
        finally:
            with self._something:
                self._urgent -= 1

    def close(self) -> None:
        """End the thread; LLVM finishes what it is at."""
        with self._something:
            self._over = True
            thread = self._thread
            self._something.notify()
        if thread is not None:
            thread.join(_END_SECONDS)

    def _wake(self) -> None:
        if self._thread is None or not (self._thread.is_alive() or self._over):
            self._thread = threading.Thread(target=self._run, name="desire fast code", daemon=True)
            self._thread.start()
        self.looks = True
        self._something.notify()

    def _take_what_is_due(self) -> float | None:
        """Take over what has waited long enough; return in how many seconds to look again, None: when woken.

        What has been enough together is taken when the next run begins.
        """
        ran = [known for known in self._waiting if known.has_run]
        left = {known: known.left() for known in ran if known.is_running}
        for known in ran:
            known.has_run = known.is_running
        self._take([known for known, seconds in left.items() if seconds <= 0.0])
        later = [seconds for seconds in left.values() if seconds > 0.0]
        self._pause = min(2.0 * self._pause, _PAUSE_MOST_SECONDS) if ran and not left else _PATIENCE_SECONDS
        return max(min(later, default=self._pause), _LOOK_SECONDS) if ran else None

    def _take(self, due: list[Waiting]) -> None:
        if due:
            self._new += [known for known in self._waiting if known in due]
            self._waiting = [known for known in self._waiting if known not in due]

    def _run(self) -> None:
        while True:
            with self._something:
                seconds = self._take_what_is_due()
                while not (self._new or self._begun or self._over):
                    self.looks = seconds is not None
                    self._something.wait(seconds)
                    seconds = self._take_what_is_due()
                self.looks = True
                if self._over:
                    return
                while self._urgent:
                    self._something.wait(_QUIET_SECONDS)
                if self._new:
                    known = self._new.pop()
                    work = known.work()
                    if work is None:
                        continue
                    self._begun.append((known, work.improve()))
                    del self._begun[:-_BEGUN_MOST]  # programs edited away
                    del work
                known, steps = self._begun[-1]
            put_off, began = False, perf_counter()
            try:
                with loading_llvm(allowed=known.may_load_llvm):
                    over = next(steps, self) is self
            except LlvmNotLoadedError:
                over = put_off = True
            except Exception as error:  # noqa: BLE001 - one model's fault must not keep fast code from the others
                over = True
                with self._something:
                    self._faults.append(error)
            if over:
                with self._something:
                    self._begun.remove((known, steps))
                    if put_off:
                        known.may_load_llvm = True
                        self._waiting.append(known)
            del known, steps
            if perf_counter() - began > _BREATH_SECONDS:
                threading.Event().wait(_BREATH_SECONDS)
