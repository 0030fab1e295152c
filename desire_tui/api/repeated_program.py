"""`desire_tui.run` of one text again and again: from the second time on it begins at the program's `drun`.

Only where that gives what the whole program would (`session.repeatable`, `session.dependent_assignments`).
"""

from __future__ import annotations

from math import inf
from threading import Lock
from time import monotonic
from typing import TYPE_CHECKING, NamedTuple

from desire_tui.api.instance import Instance, InstancePool, LoadOptions
from desire_tui.api.settings import way_of
from desire_tui.batch.runner import produced_by, result_of
from desire_tui.engine.diagnostics import Diagnostic
from desire_tui.engine.recently_used import RecentlyUsed
from desire_tui.engine.session.prepared_run import RunStart
from desire_tui.engine.session.repeatable import is_repeatable, may_be_repeated, rest_of_script

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from desire_tui.engine.outputs.results import Result, StatusWord
    from desire_tui.engine.runtime.run_record import RunRecord
    from desire_tui.engine.session.session import BackendName
    from desire_tui.engine.source import Source

PROGRAMS_MOST = 8
IDLE_MOST = 4
"""Instances that wait for the next run of a program."""


class _Key(NamedTuple):
    source: Source
    backend: BackendName


class _Repeated(Instance):
    """A program at its run, and what comes behind. `rest` None: it has to run as a whole."""

    def __init__(self, source: Source, options: LoadOptions) -> None:
        super().__init__(source, options)
        prepared = self.prepared
        prepared.advises_always = True
        rest = rest_of_script(*prepared.script, prepared.place) if is_repeatable(prepared.segment) else None
        self.rest: Callable[[], None] | None = None
        if rest is not None:
            self.rest = self.session.repeated(rest) if rest else _nothing
        self._named: list[int] | None = None
        self.mark = self.listener.mark()

    def finish(self) -> None:
        """Do what comes behind the run. DesireError: it fails."""
        assert self.rest is not None
        defined = self.session.values.defined
        before = bytes(defined)
        self.rest()
        if self._named is None:  # code that has run once takes its own names for defined
            self._named = [slot for slot, (a, b) in enumerate(zip(before, defined, strict=False)) if a < b]
        for slot in self._named:
            defined[slot] = 1

    def block(self, record: RunRecord, first_row: int) -> None:
        """Hear of samples (`runtime.simulator.Observer`)."""


def _nothing() -> None:
    return


class _Program:
    """A program that was run before."""

    def __init__(self, key: _Key) -> None:
        self._key = key
        self._lock = Lock()
        self._is_known = False
        self._pool: InstancePool[_Repeated] | None = None

    def pool(self) -> InstancePool[_Repeated] | None:
        """Return instances of it; None: it cannot be repeated."""
        with self._lock:
            if not self._is_known:
                self._is_known = True
                if may_be_repeated(self._key.source):  # before its script is run in vain
                    options = LoadOptions(backend=self._key.backend)
                    self._pool = InstancePool(lambda: _Repeated(self._key.source, options), IDLE_MOST)
            return self._pool

    def give_up(self) -> None:
        """Note that it cannot be repeated."""
        with self._lock:
            self._pool = None


_lock = Lock()
_seen = RecentlyUsed[_Key, _Program](PROGRAMS_MOST)


def repeated_result(
    source: Source, backend: BackendName, settings: Mapping[str, float], timeout: float | None
) -> Result | None:
    """Return what the whole program would give; None: it has to be run, as at its first time."""
    key = _Key(source, backend)
    with _lock:
        program = _seen[key]
        if program is None:
            _seen.age()
            _seen.keep(key, _Program(key))
            return None
    try:
        pool = program.pool()
        if pool is None:
            return None
        with pool.one() as instance:
            if instance.rest is None:
                program.give_up()
                return None
            way = instance.ways.get(names := tuple(settings))
            if way is None:
                way = instance.ways[names] = way_of(names, instance)
            if way.slots is None:
                return None
            assignments = list(zip(way.slots, settings.values(), strict=True))
            return _run(source, instance, RunStart(assignments, way.follow), timeout)
    except Exception:  # noqa: BLE001 - before or behind its run, about the settings, of ours: the whole tells
        return None


def _run(source: Source, instance: _Repeated, start: RunStart, timeout: float | None) -> Result:
    listener, session, prepared = instance.listener, instance.session, instance.prepared
    listener.rewind(instance.mark)
    session.control.deadline = inf if timeout is None else monotonic() + timeout
    status: StatusWord = "done"
    problems: list[Diagnostic] = []
    record, error = prepared.run(start, (), instance)
    listener.problems(prepared.warnings)
    if error is not None:
        status = "failed"
        problems += [d.within(source) for d in error.diagnostics]
    elif record.ended == "stopped":
        status = "limit"
        problems.append(Diagnostic("time-limit", None, {"seconds": timeout}, source))
    else:
        instance.finish()
    return result_of(source, status, listener, problems, produced_by(session, [record]))
