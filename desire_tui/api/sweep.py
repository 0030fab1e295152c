"""`Model.sweep`: a run for every place of a grid of parameters, in threads, as one xarray data set."""

from __future__ import annotations

from itertools import product
from math import inf
from os import cpu_count
from threading import Condition, Thread
from time import monotonic, perf_counter
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from desire_tui.api.interrupts import callers_code
from desire_tui.api.sweep_result import Kept, data_set, kept_of
from desire_tui.engine.diagnostics import DesireError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    import xarray as xr
    from numpy.typing import NDArray

    from desire_tui.api.instance import Instance, InstancePool
    from desire_tui.api.interrupts import Interrupts
    from desire_tui.api.sweep_result import Keep
    from desire_tui.engine.runtime.run_record import RunRecord
    from desire_tui.engine.session.prepared_run import RunStart

    Begin = Callable[[Instance, Mapping[str, float]], RunStart]
    """Returns what a run with these parameters begins with."""

_TRIED = 4
_LONG_SECONDS = 0.002
"""Runs that take longer gain by threads: of shorter ones most is Python, which runs one thread at a time."""
_TOLD_SECONDS = 0.1


class Grid(NamedTuple):
    """What varies and what does not. Places count in C order: the last name varies fastest."""

    axes: dict[str, NDArray[np.float64]]
    fixed: dict[str, float]

    @property
    def shape(self) -> tuple[int, ...]:
        """Numbers of values."""
        return tuple(map(len, self.axes.values()))

    def places(self) -> Iterator[dict[str, float]]:
        """Yield the parameters of every place."""
        for values in product(*(axis.tolist() for axis in self.axes.values())):
            yield {**self.fixed, **dict(zip(self.axes, values, strict=True))}


def grid_of(values: Mapping[str, Any], numbers: Callable[[Mapping[str, Any]], dict[str, float]]) -> Grid:
    """Return the grid that lists and numbers span. ValueError, TypeError: they span none."""
    axes: dict[str, NDArray[np.float64]] = {}
    fixed: dict[str, Any] = {}
    for name, value in values.items():
        if np.ndim(value) == 0:
            fixed[name] = value
            continue
        axis = np.asarray(value, dtype=np.float64)
        if axis.ndim != 1 or not axis.size or not np.isfinite(axis).all():
            raise ValueError(f"{name}={value!r} is no list of numbers to go through")
        axes[name] = axis
    if not axes:
        raise ValueError("nothing varies: give a parameter a list of numbers, such as k=[1, 2, 3]")
    return Grid(axes, numbers(fixed))


class Sweep:
    """Makes the runs of a grid."""

    def __init__(
        self,
        pool: InstancePool[Instance],
        begin: Begin,
        record: tuple[str, ...],
        keep: Keep,
        program: str,
        interrupts: Interrupts,
    ) -> None:
        self._pool, self._begin, self._record = pool, begin, record
        self._keep, self._program, self._interrupts = keep, program, interrupts
        self._timeout: float | None = None
        self._changed = Condition()
        self._done = 0
        self._over = False
        self._busy: list[Instance] = []
        self._fault: BaseException | None = None

    def run(
        self,
        grid: Grid,
        workers: int | None,
        progress: Callable[[int, int], object] | None,
        timeout: float | None,
    ) -> xr.Dataset:
        """Make all runs. Ctrl-C ends them all."""
        places = list(grid.places())
        self._timeout = timeout
        self._found: list[Kept | None] = [None] * len(places)
        self._waiting = iter(enumerate(places))
        self._total, self._progress, self._told = len(places), progress, monotonic()
        try:
            if workers is None:
                workers = self._work_of_a_few()
            if workers > 1 and self._done < self._total:
                self._in_threads(min(workers, self._total - self._done))
            else:
                self._work(inf, tells=True)
        finally:
            self._over = True
        if self._progress is not None and not self._interrupts.came:
            with callers_code():
                self._progress(self._done, self._total)
        if self._fault is not None:
            raise self._fault
        if self._interrupts.came:
            raise KeyboardInterrupt
        return data_set(grid.axes, grid.fixed, [k for k in self._found if k is not None], self._program)

    def _work_of_a_few(self) -> int:
        """Make a few runs and return how many threads will make the others."""
        self._work(1, tells=True)  # compiles
        began, before = perf_counter(), self._done
        self._work(_TRIED, tells=True)
        made = self._done - before
        is_long = made and (perf_counter() - began) / made > _LONG_SECONDS
        return (cpu_count() or 1) if is_long else 1

    def _in_threads(self, workers: int) -> None:
        threads = [
            Thread(target=self._work_apart, name=f"desire sweep {number}", daemon=True)
            for number in range(workers)
        ]
        for thread in threads:
            thread.start()
        try:
            while any(thread.is_alive() for thread in threads):
                with self._changed:
                    self._changed.wait(_TOLD_SECONDS)
                self._tell()
                if self._interrupts.came:
                    break
        finally:
            self._end()
            for thread in threads:
                thread.join()

    def _end(self) -> None:
        with self._changed:
            self._over = True
            for instance in self._busy:
                instance.session.control.doom()

    def _work_apart(self) -> None:
        try:
            self._work(inf, tells=False)
        except BaseException as fault:  # noqa: BLE001 - raised in the caller's thread
            self._fault = fault
            self._end()
        with self._changed:
            self._changed.notify()

    def _work(self, most: float, *, tells: bool) -> None:
        """Make so many runs, or all that are left, with one instance."""
        with self._pool.one() as instance:
            with self._changed:
                self._busy.append(instance)
            try:
                while most > 0:
                    with self._changed:
                        number, parameters = next(self._waiting, (-1, {}))
                        if number < 0 or self._over or self._interrupts.came:
                            return
                    self._found[number] = self._one(instance, parameters)
                    most -= 1
                    with self._changed:
                        self._done += 1
                    if tells:
                        self._tell()
            finally:
                with self._changed:
                    self._busy.remove(instance)
                    if not tells:
                        instance.session.control.spare()

    def _one(self, instance: Instance, parameters: Mapping[str, float]) -> Kept:
        control = instance.session.control
        control.deadline = inf if self._timeout is None else monotonic() + self._timeout
        try:
            start = self._begin(instance, parameters)
            prepared = instance.prepared
            made, error = prepared.run(start, self._record, _NOBODY)
        except DesireError as fault:  # the run cannot begin
            return Kept(None, {}, fault.message)
        if error is not None:
            return Kept(None, {}, error.message)
        if made.ended == "stopped":
            if self._timeout is None:  # nobody will look at it
                return Kept(None, {}, made.ended)
            return Kept(None, {}, f"stopped after {self._timeout:g} second(s), the limit given")
        with callers_code():
            return kept_of(made, self._keep, prepared, self._program)

    def _tell(self) -> None:
        now = monotonic()
        if self._progress is not None and now - self._told > _TOLD_SECONDS:
            self._told = now
            with callers_code():
                self._progress(self._done, self._total)


class _Nobody:
    def block(self, record: RunRecord, first_row: int) -> None:
        """Hear of samples."""


_NOBODY = _Nobody()
