"""A program brought to its first `drun`, and that run made any number of times, each from the same start."""

from __future__ import annotations

from functools import cached_property
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.integration.rules import DUMMY
from desire_tui.engine.passes.replication import LockStepError
from desire_tui.engine.passes.variational import variational
from desire_tui.engine.runtime.gap_warnings import gap_warnings
from desire_tui.engine.runtime.measured_points import point_sets
from desire_tui.engine.runtime.run_record import RunRecord
from desire_tui.engine.runtime.start_values import StartQuantities, start_slots
from desire_tui.engine.runtime.tables import check_tables
from desire_tui.engine.session.checkpoint import Checkpoint
from desire_tui.engine.session.fault_place import with_part
from desire_tui.engine.session.recorded_segment import recording
from desire_tui.engine.session.state_labels import state_labels
from desire_tui.engine.values import TMAX, T

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    from numpy.typing import NDArray

    from desire_tui.engine.codegen.lanes.lane_model import LaneModel
    from desire_tui.engine.lowered.segment import SampleColumn, Segment
    from desire_tui.engine.nodes.program import Placed
    from desire_tui.engine.passes.variational import Variational
    from desire_tui.engine.runtime.equations import Equations
    from desire_tui.engine.runtime.pause_and_stop import Control
    from desire_tui.engine.runtime.plan import RunPlan
    from desire_tui.engine.runtime.simulator import Observer, Simulator
    from desire_tui.engine.runtime.start_values import StartValues
    from desire_tui.engine.session.runs import Runs
    from desire_tui.engine.session.workspace import Workspace
    from desire_tui.engine.values import Values

    Assignments = Iterable[tuple[int, float]]
    """Numbers for slots."""


class RunReached(BaseException):
    """The script has come to a `drun` which its caller is to make. Passes what explains errors."""

    def __init__(self, label: str | None, placed: Placed | None) -> None:
        super().__init__()
        self.label, self.placed = label, placed


@dataclass(frozen=True)
class RunStart:
    """What a run begins with in place of what the script gave. Later ones win.

    `settings` hold while `follow` computes again what the script computes from them; `initial` holds for the
    run alone.
    """

    settings: Assignments = ()
    follow: Callable[[], None] | None = None
    initial: Assignments = ()
    t0: float | None = None
    t1: float | None = None
    random: int | None = None
    """Where the run's random numbers begin."""


class PreparedRun:
    """Lives on one thread at a time. `segment` is compiled; `base` is where every run begins."""

    def __init__(
        self, workspace: Workspace, runs: Runs, control: Control, reached: RunReached, rule: int
    ) -> None:
        self._workspace, self._runs, self._control = workspace, runs, control
        self.values: Values = workspace.values
        self._label, self._rule = reached.label, rule
        placed = reached.placed
        self._source = workspace.source_of(placed) if placed is not None else workspace.source
        self._span = placed.span() if placed is not None else None
        self._line = workspace.line_of(placed) if placed is not None else 0
        program, structure = self.script = workspace.runnable()
        script = program.script
        self.place = next((k for k, other in enumerate(script) if other is placed), len(script))
        """Of the `drun` in the script."""
        try:
            self.segment = workspace.segments.lowered(program, structure, reached.label, rule)
        except DesireError as error:
            raise error if self._span is None else error.placed(self._span, self._source) from None
        workspace.segments.model(self.segment, rule if self.segment.order else DUMMY)
        self.base = Checkpoint.taken(self.values, runs.simulator)
        self._recording: dict[tuple[str, ...], Segment] = {(): self.segment}
        self._sensitive: dict[tuple[object, ...], Variational] = {}
        self._states = np.array(
            [slot for s in self.segment.states for slot in range(s.slot, s.slot + s.count)], dtype=np.intp
        )
        self._starts = StartQuantities(self.segment, self.values)
        self._starts.start(self.values, None, continues=False)
        self.advises_always = False
        """What a model has to say before a run is said before each, not only before its first."""
        self.warnings: list[Diagnostic] = []
        """Of the last run."""

    def start_values(self) -> StartValues:
        """Return parameters and states as every run finds them."""
        self.base.restore(self.values, self._runs.simulator)
        return self._starts.start(self.values, None, continues=False)

    def run(
        self,
        start: RunStart,
        record: tuple[str, ...],
        observer: Observer,
        base: Checkpoint | None = None,
        *,
        continues: bool = False,
        explains: bool = True,
        form: Segment | None = None,
    ) -> tuple[RunRecord, DesireError | None]:
        """Make the run; an error leaves the samples that came before it.

        `record` names what is sampled besides the program's own requests; `base` is another place to begin
        at, `checkpoint()` of an earlier run which this one `continues` perhaps. `explains`: of an inf or nan
        the error says what made it, which takes some milliseconds. `form` is another form of the segment in
        place of that which samples `record`, such as that of `sensitive`. DesireError: the run cannot begin.
        """
        began = perf_counter()
        workspace, simulator = self._workspace, self._runs.simulator
        segment = form or self.sampled(record)
        self.begin(start, base)
        if segment.recover:
            path = workspace.stash_path("read", lambda _: False)
            segment = workspace.segments.recovering(segment, path)
        plan = simulator.defaults.plan(segment, self._rule, self._source, self._span)
        begins = self._starts.start(self.values, None, continues=continues)
        self.warnings = list(simulator.defaults.warnings())
        forward, segment = segment, workspace.segments.directed(segment, plan)
        model = workspace.segments.model_of(segment, plan)
        self.warnings += [
            *self._runs.advice(model, forward, again=self.advises_always),
            *segment.warnings,
        ]
        self._runs.count += 1
        made = RunRecord(
            number=self._runs.count, segment=self._label, line=self._line, requests=segment.requests,
            columns=segment.columns, overlay=False, rule=plan.rule, scale=plan.scale, t0=plan.t0,
            t_max=plan.span, nn=plan.nn, dt=plan.dt, error_max=plan.tolerance,
            start=begins, compile_seconds=perf_counter() - began, points=point_sets(segment, self.values),
        )  # fmt: skip
        self._control.begin()
        try:
            simulator.run(model, segment, plan, made, observer)
        except DesireError as fault:
            made.ended = "failed"
            explained = fault
            if explains:
                explained = with_part(fault, simulator, segment, plan, model, self.values)
            made.message = explained.diagnostics[0].message
            return made, self._placed(explained)
        finally:
            self._control.done()
            self.warnings += [*gap_warnings(segment, made), *simulator.cut_delays()]
        self.warnings += workspace.segments.backend.problems()
        return made, None

    def equations(self) -> Equations:
        """Return the derivatives as functions of t and x, with parameters as `begin` left them.

        DesireError 491: they depend on something else too. 44: a table's breakpoints fall.
        """
        check_tables(self.segment, self.values)
        return self._workspace.segments.backend.equations(self.segment, self.values)

    def begin(self, start: RunStart, base: Checkpoint | None = None) -> None:
        """Put everything where a run begins."""
        (base or self.base).restore(self.values, self._runs.simulator)
        self._assign(start)

    def lanes(
        self, given: Sequence[int], columns: Sequence[str], folds: Sequence[str], *, fast: bool
    ) -> LaneModel:
        """Return the run compiled for several at a time, which differ in the `given` slots.

        `columns` are sampled; of each is kept what `folds` says, if it says something. LockStepError: what
        keeps the runs from going in lock step.
        """
        backend = self._workspace.segments.backend
        make = getattr(backend, "lanes", None)
        if make is None:
            raise LockStepError("the back end compiles nothing")
        if self.base.history.positions is not None:
            raise LockStepError("the run continues another")
        slots = {column.name: column.slot for column in self.segment.columns}
        model: LaneModel = make(
            self.segment, self._rule, self.values, given, [slots[name] for name in columns], folds, fast=fast
        )
        return model

    def planned(self, start: RunStart) -> RunPlan:
        """Make everything as it is when a run begins; return the run's plan. DesireError: it cannot begin."""
        self.begin(start)
        plan = self._runs.simulator.defaults.plan(self.segment, self._rule, self._source, self._span)
        check_tables(self.segment, self.values)
        for level in self.segment.levels:
            self.values.cells[level] = 0.0
        return plan

    @property
    def simulator(self) -> Simulator:
        """What makes the runs."""
        return self._runs.simulator

    def state_slots(self) -> NDArray[np.intp]:
        """Return where all states stand, in their order."""
        return self._states

    def state(self) -> NDArray[np.float64]:
        """Return all states as they are now."""
        return self.values.data[self._states]

    def state_names(self) -> tuple[str, ...]:
        """Return the names of all states in their order."""
        return tuple(name for name, _ in self.states())

    def states(self) -> Iterator[tuple[str, float]]:
        """Yield names and values of all states, now."""
        labels = state_labels(self.values)
        data = self.values.data
        yield from ((labels[slot], float(data[slot])) for slot in self._states.tolist())

    def checkpoint(self) -> Checkpoint:
        """Return what the last run left, as a place for others to begin at."""
        return Checkpoint.taken(self.values, self._runs.simulator)

    def end(self) -> None:
        """End the run that goes on; from any thread."""
        self._control.end()

    def sampled(self, record: tuple[str, ...]) -> Segment:
        """Return the segment that samples more quantities. DesireError 409: they are not there."""
        known = self._recording.get(record)
        if known is None:
            known = self._recording[record] = recording(self.segment, record, self.values)
        return known

    def outputs(self, record: tuple[str, ...]) -> tuple[SampleColumn, ...]:
        """Return the columns that names stand for: of an array all its elements. DesireError 409."""
        columns = {column.name: column for column in self.sampled(record).columns}
        return tuple(
            column
            for column in columns.values()
            if any(column.name == name or column.name.startswith(f"{name}[") for name in record)
        )

    @cached_property
    def start_slots(self) -> NDArray[np.intp]:
        """Where the numbers stand that a run begins with: what the segment reads, and the states."""
        return start_slots(self.segment)

    def sensitive(
        self, record: tuple[str, ...], directions: tuple[tuple[str, tuple[int, ...]], ...]
    ) -> Variational:
        """Return the segment with the derivatives of what is recorded: see `passes.variational`.

        DesireError 409: a name that is not there. NotDifferentiable: there are no such derivatives.
        """
        key = record, directions
        known = self._sensitive.get(key)
        if known is None:
            segment = self.sampled(record)
            outputs = self.outputs(record)
            known = self._sensitive[key] = variational(segment, directions, outputs, self.values.room)
        return known

    def _assign(self, start: RunStart) -> None:
        assign = self.values.assign
        for slot, value in start.settings:
            assign(slot, value)
        if start.follow is not None:
            start.follow()
            for slot, value in start.settings:
                assign(slot, value)
        for slot, value in start.initial:
            assign(slot, value)
        if start.random is not None:
            self.values.random[0] = start.random
        if start.t0 is not None:
            assign(T, start.t0)
        if start.t1 is not None:
            assign(TMAX, start.t1 - (self.values.cells[T] if self.values.defined[T] else 0.0))

    def _placed(self, error: DesireError) -> DesireError:
        placed = error if self._span is None else error.placed(self._span, self._source)
        return DesireError(*(d.within(self._source) for d in placed.diagnostics))
