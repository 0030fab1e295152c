"""Runs of a prepared program side by side in vector code, where nothing keeps them from lock step."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.codegen.lanes.lane_folds import FOLDS
from desire_tui.engine.codegen.lanes.lane_model import LaneRows
from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.passes.replication import LockStepError
from desire_tui.engine.session.prepared_run import RunStart

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from desire_tui.api.instance import Way
    from desire_tui.engine.runtime.plan import RunPlan
    from desire_tui.engine.session.prepared_run import PreparedRun

    Floats = NDArray[np.float64]

_NUMBERS_MOST = 1 << 18
"""Samples of runs made together: they stay in the cache until they are reduced."""


_GROUPS_MOST = 256


class LockStep:
    """Lives on one thread at a time. LockStepError: what keeps the runs from going in lock step."""

    def __init__(
        self,
        prepared: PreparedRun,
        way: Way,
        varied: Way,
        columns: Sequence[str],
        kinds: Sequence[str],
        *,
        fast: bool,
    ) -> None:
        """`way` is that of all settings, `varied` that of those which differ: they come first.

        `kinds`: what is kept of each of the `columns`.
        """
        if way.slots is None or varied.slots is None:
            raise LockStepError("the script has to run for each run")
        self._prepared, self._way, self._follow = prepared, way, varied.follow
        self._given = list(dict.fromkeys((*varied.slots, *varied.computed)))
        self._places = [self._given.index(slot) for slot in varied.slots]
        self._follows, self._overwritten = varied.computed, frozenset(way.computed)
        self._computed = [self._given.index(slot) for slot in varied.computed]
        self._model = prepared.lanes(
            self._given, columns, kinds if FOLDS.issuperset(kinds) else (), fast=fast
        )
        self.draws = self._model.draws
        """Whether the model takes random numbers."""
        self.width = self._model.width
        """Runs of a group: they take as long as one of them."""
        self._row = (1 + len(columns)) * self.width
        self.runs_most = self.width
        """Runs to be made at a time."""

    def end(self) -> None:
        """End the runs that go on; from any thread."""
        self._model.memory.stop = 1

    def run(self, settings: Floats, random: NDArray[np.uint64] | None) -> LaneRows:
        """Make runs; those flagged have to be made alone. `random`: where their random numbers begin."""
        runs = len(settings)
        seeds = np.zeros(runs, dtype=np.uint64) if random is None else random
        try:
            starts, plan, failed = self._starts(settings)
            numbers = self._row * (1 if self._model.folds else plan.rows_most)
            self.runs_most = self.width * max(1, min(_GROUPS_MOST, _NUMBERS_MOST // numbers))
            made = self._model.run(plan, starts, seeds)
        except DesireError:
            nothing = np.zeros((1, 1, runs))
            return LaneRows(nothing, np.ones(runs, dtype=np.int64), np.ones(runs, dtype=np.bool_))
        return made._replace(flagged=made.flagged | failed)

    def _starts(self, settings: Floats) -> tuple[Floats, RunPlan, NDArray[np.bool_]]:
        """Return what each run begins with, the plan of all, and whose script fails on its way there."""
        prepared, way = self._prepared, self._way
        assert way.slots is not None
        failed = np.zeros(len(settings), dtype=np.bool_)
        first = tuple(zip(way.slots, settings[0].tolist(), strict=True))
        plan = prepared.planned(RunStart(first, way.follow))
        data = prepared.values.data
        if plan.backward:
            return np.empty((len(settings), len(self._given))), plan, ~failed
        starts = np.repeat(data[None, self._given], len(settings), axis=0)
        if self._follow is not None:
            failed = self._let_follow(self._follow, settings, way.slots, starts)
        starts[:, self._places] = settings[:, : len(self._places)]
        return starts, plan, failed

    def _let_follow(
        self, follow: Callable[[], None], settings: Floats, slots: Sequence[int], starts: Floats
    ) -> NDArray[np.bool_]:
        """Put what the script computes from each run's settings into its start; return whose script fails."""
        failed = np.zeros(len(settings), dtype=np.bool_)
        cells = self._prepared.values.cells  # the plan's run has defined all of them
        computed = starts[:, self._computed]
        again = not self._overwritten.isdisjoint(slots)
        for number, row in enumerate(settings.tolist()):
            for slot, value in zip(slots, row, strict=True):
                cells[slot] = value
            try:
                follow()
            except DesireError:
                failed[number] = True
                continue
            if again:
                for slot, value in zip(slots, row, strict=True):
                    cells[slot] = value
            computed[number] = [cells[slot] for slot in self._follows]
        starts[:, self._computed] = computed
        return failed
