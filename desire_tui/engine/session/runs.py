"""A session's runs: how one is made, their records, and where the last one began."""

from __future__ import annotations

from contextlib import contextmanager
from time import perf_counter
from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import DesireError, Diagnostic, internal_error
from desire_tui.engine.interpreter.host import Interrupted
from desire_tui.engine.nodes.names import assigned
from desire_tui.engine.runtime.gap_warnings import gap_warnings
from desire_tui.engine.runtime.measured_points import outside_warnings, point_sets
from desire_tui.engine.runtime.run_record import RunRecord
from desire_tui.engine.runtime.simulator import Simulator
from desire_tui.engine.runtime.start_values import StartQuantities
from desire_tui.engine.runtime.stash import write_stash
from desire_tui.engine.runtime.stiffness_warning import stiffness_warning
from desire_tui.engine.session.checkpoint import NUMBERS_MOST, Checkpoint
from desire_tui.engine.session.fault_place import with_part

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator
    from pathlib import Path

    import numpy as np
    from numpy.typing import NDArray

    from desire_tui.engine.graph.pages import GraphPages
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.nodes.program import Placed, Program
    from desire_tui.engine.runtime.backend import Model
    from desire_tui.engine.runtime.pause_and_stop import Control
    from desire_tui.engine.runtime.start_values import StartValues
    from desire_tui.engine.session.listener import Listener
    from desire_tui.engine.session.type_output import TypeOutput
    from desire_tui.engine.session.workspace import Workspace
    from desire_tui.engine.source import Span
    from desire_tui.engine.values import Values

RUNS_BYTES_MAX = 1 << 30
"""Samples of all runs kept; the oldest go first."""
THINNED_ROWS = 10_000
"""Samples left of those, for the graphs that show them."""


class Runs:
    """Makes runs and keeps their records. Lives on the session's thread."""

    def __init__(
        self, workspace: Workspace, listener: Listener, control: Control, graphs: GraphPages
    ) -> None:
        self._workspace = workspace
        self._listener = listener
        self._graphs = graphs
        self._values: Values = workspace.values
        self.simulator = Simulator(workspace.values, control)
        self.kept: list[RunRecord] = []
        """Records since the program started, oldest first."""
        self.count = 0
        """Runs made since then."""
        self._bytes = 0  # of all samples kept but the newest run's
        self._scale_of: tuple[Program | None, bool] = (None, False)
        self._starts: tuple[Segment, StartQuantities] | None = None  # of the segment that ran last
        self._left: tuple[NDArray[np.intp], NDArray[np.float64]] | None = None  # its states and their end
        self.start: Checkpoint | None = None
        """Where the last run began, unless the model is large."""
        self._gaps: set[Span | None] = set()  # places of the variables that have been warned of since then
        self._not_stashed = False  # whether the last run of a segment with `stash` was made by `drun *`
        self.run_of: tuple[str, int] | None = None
        """The last run's program text, and `Values.generation` then."""

    def make(
        self,
        label: str | None,
        placed: Placed,
        rule: int,
        *,
        star: bool,
        ahead: int | None,
        on_start: Callable[[RunRecord], TypeOutput],
    ) -> None:
        """Make one run of a segment, to its end; `star`: its stash is not written.

        `ahead`: so many runs of the script follow, if that is known.

        `on_start` is called once the model is compiled; it returns what lists the run's `type` lines.
        """
        workspace, began = self._workspace, perf_counter()
        program, structure = workspace.runnable()
        anew = self.simulator.history.is_compiled_anew(label)
        try:
            segment = workspace.segments.lowered(program, structure, label, rule, anew=anew)
        except DesireError as error:
            raise error.placed(placed.span(), workspace.source_of(placed)) from None
        if segment.recover:
            path = workspace.stash_path("read", self._listener.permit)
            recovered = segment.recover[0].where.span
            segment = workspace.segments.recovering(segment, path)
            if self._not_stashed:
                problem = Diagnostic(
                    "stash-of-an-earlier-run", recovered, source=segment.source, severity="warning"
                )
                self._listener.problems((problem,))
        stash = workspace.stash_path("write", self._listener.permit) if segment.stash and not star else None
        start = self._checkpoint()
        plan = self.simulator.defaults.plan(segment, rule, workspace.source_of(placed), placed.span())
        replaced = self.simulator.defaults.warnings()
        if replaced:
            self._listener.problems(replaced)
        forward, segment = segment, workspace.segments.directed(segment, plan)
        model = workspace.segments.model_of(segment, plan)
        self._warn_before(model, forward)
        points = point_sets(segment, self._values)
        self.start, self.run_of = start, (program.source.text, self._values.generation)
        self.count += 1
        record = RunRecord(
            number=self.count, segment=label, line=workspace.line_of(placed), requests=segment.requests,
            columns=segment.columns, overlay=self._graphs.settings.mode == 2, rule=plan.rule,
            scale=plan.scale, t0=plan.t0, t_max=plan.span, nn=plan.nn, dt=plan.dt, error_max=plan.tolerance,
            start=self._start_values(segment, start), compile_seconds=perf_counter() - began,
            points=points,
        )  # fmt: skip
        self._keep(record)
        self._warn_once(outside_warnings(segment, record))
        graph = self._graphs.begin_run(
            record, segment.pictures,
            program=program.source.file_name, has_scale=plan.scale != 1.0 or self._sets_scale(program),
            ahead=ahead,
        )  # fmt: skip
        type_output = on_start(record)
        self._listener.run_started(record)
        if graph is not None:
            self._listener.graph_changed(graph)
        try:
            finished = self.simulator.run(model, segment, plan, record, type_output)
        except DesireError as fault:
            record.ended = "failed"
            explained = with_part(fault, self.simulator, segment, plan, model, self._values)
            if explained is not fault or not record.message:
                record.message = explained.diagnostics[0].message
            raise explained.placed(placed.span(), workspace.source_of(placed)) from None
        except Exception as error:
            record.ended = "failed"
            record.message = internal_error("the run went on", error).message
            raise
        finally:
            if self._starts is not None:
                states = self._starts[1].states
                self._left = states, self._values.data[states]
            self._warn_once(gap_warnings(segment, record))
            self._warn_once(stiffness_warning(segment, record))
            self._warn_once(self.simulator.cut_delays())
            workspace.notebook.run_ended(record, workspace.overrides)
            self._listener.run_ended(record)
        problems = workspace.segments.backend.problems()
        if problems:
            self._listener.problems(problems)
        if not finished:
            raise Interrupted
        if workspace.segments.start is not None:
            workspace.segments.start.keep(segment, model)
        if segment.stash:
            self._not_stashed = star
        if stash is not None:
            self._stash(stash, segment, record)

    def _warn_before(self, model: Model, segment: Segment) -> None:
        """Show what can be told of a run in front of it, once a program."""
        problems = self.advice(model, segment)
        if problems:
            self._listener.problems(problems)
            self._gaps.update(problem.span for problem in problems)  # 463 says why a corrector will be slow
        self._warn_once(segment.warnings)

    def _start_values(self, segment: Segment, start: Checkpoint | None) -> StartValues:
        if self._starts is None or self._starts[0] is not segment:
            if self._starts is not None:
                self._starts[1].settle()
            self._starts = segment, StartQuantities(segment, self._values)
        continues = self._left is not None and bool((self._values.data[self._left[0]] == self._left[1]).all())
        saved = start.saved if start is not None else None
        return self._starts[1].start(self._values, saved, continues=continues)

    def _warn_once(self, problems: Iterable[Diagnostic]) -> None:
        """Show what a run has to say about its lines, about each line once in a program."""
        new = [problem for problem in problems if problem.span not in self._gaps]
        self._gaps.update(problem.span for problem in new)
        if new:
            self._listener.problems(new)

    def _sets_scale(self, program: Program) -> bool:
        """Whether a program gives `scale` a value anywhere."""
        if self._scale_of[0] is not program:
            targets = (target for placed in program.script for target in assigned(placed.node).targets)
            self._scale_of = program, any(target.name == "scale" for target in targets)
        return self._scale_of[1]

    def _checkpoint(self) -> Checkpoint | None:
        values = self._values
        return Checkpoint.taken(values, self.simulator) if values.numbers_used <= NUMBERS_MOST else None

    def advice(self, model: Model, segment: Segment, *, again: bool = False) -> tuple[Diagnostic, ...]:
        """Return what a model has to say before its first run, `again`: before any (multistep rules)."""
        advice = getattr(model, "advice", None)
        problems: tuple[Diagnostic, ...] = advice(again=again) if advice is not None else ()
        if any(p.key == "jacobian-wrong" for p in problems):
            problems = self._exactly(segment, problems)
        return problems

    def _exactly(self, segment: Segment, found: tuple[Diagnostic, ...]) -> tuple[Diagnostic, ...]:
        """Judge a JACOBIAN that disagrees with differences by exact derivatives: differences err at kinks."""
        from desire_tui.engine.reference.jacobian import wrong_elements

        with self.restored():
            exact = wrong_elements(segment, self._values)
        return found if exact is None else exact

    @staticmethod
    def _stash(path: Path, segment: Segment, record: RunRecord) -> None:
        first = 1 + len(record.columns) - len(segment.stash)
        write_stash(path, record.rows[: record.count, first:])

    def _keep(self, record: RunRecord) -> None:
        if self.kept:
            self._bytes += self.kept[-1].rows.nbytes
        self.kept.append(record)
        while self._bytes > RUNS_BYTES_MAX:
            oldest = self.kept.pop(0)
            self._bytes -= oldest.rows.nbytes
            oldest.thin(THINNED_ROWS)  # pages may show it still

    def forget(self) -> None:
        """Begin a program: its runs count from 1."""
        self.kept.clear()
        self._gaps.clear()
        self._graphs.limit_memory()
        self._not_stashed = False
        if self._starts is not None:
            self._starts[1].forget()
        self._starts = self._left = self.start = self.run_of = None
        self.count = self._bytes = 0

    @contextmanager
    def restored(self) -> Iterator[None]:
        """Put everything that a run could change back afterwards."""
        before = Checkpoint.taken(self._values, self.simulator)
        try:
            yield
        finally:
            before.restore(self._values, self.simulator)

    def go_back(self) -> None:
        """Go to where the last run began: everything as it was, or (large models) t, DT and states only."""
        if self.start is not None:
            self.start.restore(self._values, self.simulator)
        else:
            self.simulator.reset()
