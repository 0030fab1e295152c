"""Runs of a model with the derivatives of what they sample, by parameters and by initial values."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from desire_tui.api.arguments import checked_names
from desire_tui.api.block import Blocks
from desire_tui.api.interrupts import Interrupts
from desire_tui.api.start_derivatives import start_derivatives
from desire_tui.engine.passes.tangents import NotDifferentiable
from desire_tui.engine.session.prepared_run import RunStart
from desire_tui.engine.values import NN

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from numpy.typing import NDArray

    from desire_tui.api.instance import Instance, InstancePool
    from desire_tui.api.run_start import RunStarts
    from desire_tui.api.start_derivatives import Start
    from desire_tui.engine.diagnostics import DesireError

    Floats = NDArray[np.float64]

_STENCIL = ((-2.0, 1.0 / 12.0), (-1.0, -8.0 / 12.0), (1.0, 8.0 / 12.0), (2.0, -1.0 / 12.0))
"""Places in steps of h and weights in 1/h of a difference of order 4."""
_STEP = 1e-3


class SensitiveRun(NamedTuple):
    """A run: `values` (outputs, samples) over `t`, `derivatives` (parameters, outputs, samples).

    `is_exact`: the derivatives were integrated along the run; else they are differences of runs, of order 4.
    `error` is what ended the run early.
    """

    t: Floats
    names: tuple[str, ...]
    values: Floats
    derivatives: Floats
    is_exact: bool
    error: DesireError | None


class SensitiveRuns:
    """Makes runs of a model; called with values for the parameters. One thread at a time."""

    def __init__(
        self,
        pool: InstancePool[Instance],
        starts: RunStarts,
        parameters: Iterable[str],
        record: Iterable[str],
        states: Mapping[str, float],
    ) -> None:
        self.parameters = checked_names(parameters)
        """By what derivatives are taken: names of parameters, and of states for their initial values."""
        self.record = checked_names(record)
        self._pool, self._starts = pool, starts
        self._initial = frozenset(states)
        self._slots: list[set[int]] = [set() for _ in self.parameters]
        self.is_exact = True
        """Whether derivatives are integrated along the runs; known behind the first one."""

    def __call__(
        self, values: Mapping[str, float] | None = None, *, samples: int | None = None,
        t: tuple[float, float] | None = None, derivatives: bool = True,
    ) -> SensitiveRun:  # fmt: skip
        """Make a run with other `values` of parameters and of states at the start.

        `samples` takes the place of NN. DesireError: the run cannot begin.
        """
        given = dict(values or {})
        with Interrupts(), self._pool.one() as instance:
            by = self.parameters if derivatives else ()
            if by and self.is_exact:
                try:
                    made = self._exact(instance, given, samples, t)
                except NotDifferentiable:
                    self.is_exact = False
                else:
                    if made.error is None:
                        return made
            run = self._plain(instance, given, samples, t)
            if by and self.is_exact and run.error is not None:
                return made  # it is the run that fails, not its derivatives: where something slides, for one
            if not by:
                return run
            return run._replace(derivatives=self._differences(instance, run, given, samples, t))

    # ------------------------------------------------------------------ exact

    def _exact(
        self,
        instance: Instance,
        given: Mapping[str, float],
        samples: int | None,
        t: tuple[float, float] | None,
    ) -> SensitiveRun:
        at = self._start(instance, given, t)
        prepared = instance.prepared
        for slots, found in zip(self._slots, at.derivatives, strict=True):
            slots.update(found)  # the segment stays the same where a derivative is 0 for once
        directions = tuple(zip(self.parameters, (tuple(sorted(slots)) for slots in self._slots), strict=True))
        form = prepared.sensitive(self.record, directions)
        scales = [abs(at.values[name]) or 1.0 for name in self.parameters]
        tangents: dict[int, float] = dict(form.memory)
        for pieces, found, scale in zip(form.tangents, at.derivatives, scales, strict=True):
            for slot, tangent, count in pieces:
                for number in range(count):
                    tangents[tangent + number] = scale * found.get(slot + number, 0.0)
        start = self._begin(instance, given, t)
        start = RunStart(
            (*start.settings, *self._sampled(samples)), start.follow, (*start.initial, *tangents.items()),
            start.t0, start.t1,
        )  # fmt: skip
        made, error = prepared.run(start, (), Blocks(None, prepared), explains=False, form=form.segment)
        rows = made.rows[: made.count]
        count = len(form.columns[0])
        names = tuple(column.name for column in form.segment.stash[:count])
        derivatives = np.zeros((len(scales), count, made.count))
        for k, (columns, scale) in enumerate(zip(form.columns, scales, strict=True)):
            for output, column in enumerate(columns):
                if column is not None:
                    derivatives[k, output] = rows[:, 1 + column] / scale
        return SensitiveRun(
            rows[:, 0].copy(), names, rows[:, 1 : 1 + count].T.copy(), derivatives, is_exact=True, error=error
        )

    # ------------------------------------------------------------------ differences

    def _plain(
        self,
        instance: Instance,
        given: Mapping[str, float],
        samples: int | None,
        t: tuple[float, float] | None,
    ) -> SensitiveRun:
        start = self._begin(instance, given, t)
        prepared = instance.prepared
        start = RunStart(
            (*start.settings, *self._sampled(samples)), start.follow, start.initial, start.t0, start.t1
        )
        made, error = prepared.run(start, self.record, Blocks(None, prepared), explains=False)
        names = tuple(column.name for column in prepared.outputs(self.record))
        values = np.array([made.values(name) for name in names]).reshape(len(names), made.count)
        nothing = np.zeros((0, len(names), made.count))
        return SensitiveRun(made.t.copy(), names, values, nothing, is_exact=False, error=error)

    def _differences(
        self, instance: Instance, run: SensitiveRun, given: Mapping[str, float], samples: int | None,
        t: tuple[float, float] | None,
    ) -> Floats:  # fmt: skip
        at = self._start(instance, given, t)
        found = np.zeros((len(self.parameters), *run.values.shape))
        for k, name in enumerate(self.parameters):
            value = at.values[name]
            h = _STEP * (abs(value) or 1.0)
            for place, weight in _STENCIL:
                other = self._plain(instance, {**given, name: value + place * h}, samples, t)
                count = min(len(other.t), len(run.t))
                found[k, :, :count] += weight / h * other.values[:, :count]
                found[k, :, count:] = np.nan
        return found

    # ------------------------------------------------------------------ both

    def _start(self, instance: Instance, given: Mapping[str, float], t: tuple[float, float] | None) -> Start:
        return start_derivatives(
            self.parameters, given, instance, self._initial, lambda values: self._begin(instance, values, t),
            lambda names: self._starts.way(instance, names, {}),
        )  # fmt: skip

    def _begin(
        self, instance: Instance, given: Mapping[str, float], t: tuple[float, float] | None
    ) -> RunStart:
        settings = {name: value for name, value in given.items() if name not in self._initial}
        initial = {name: value for name, value in given.items() if name in self._initial}
        return self._starts.start(instance, settings, initial or None, t, {})

    def _sampled(self, samples: int | None) -> Sequence[tuple[int, float]]:
        return () if samples is None else ((NN, float(samples)),)
