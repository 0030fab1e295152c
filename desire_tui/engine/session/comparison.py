"""`compare rule n` [X]: the last run once more under another rule, and how far the curves lie apart."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import dataclass, replace
from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.integration.rules import DUMMY, rule_numbered
from desire_tui.engine.interpreter.host import Interrupted
from desire_tui.engine.lowered.segment import SampleColumn
from desire_tui.engine.lowered.statements import Where
from desire_tui.engine.passes.slices import full_pass, is_pure
from desire_tui.engine.runtime.measured_points import point_sets
from desire_tui.engine.runtime.run_record import RunRecord
from desire_tui.engine.session.differences import needs_steps_of, table
from desire_tui.engine.source import Span
from desire_tui.engine.values import DT, ERMAX

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from desire_tui.engine.graph.model import Graph
    from desire_tui.engine.graph.pages import GraphPages
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.session.runs import Runs
    from desire_tui.engine.session.workspace import Workspace


@dataclass(frozen=True)
class Variation:
    """What the run is repeated with; None: as it was."""

    rule: int | None = None
    dt: float | None = None
    error_max: float | None = None

    @classmethod
    def parse(cls, argument: str) -> Variation:
        """Read `rule 4`, `DT 0.001`, `rule 14 ERMAX 1.0E-08`. DesireError 404, 86."""
        words = argument.split()
        found: dict[str, float] = {}
        for word, number in zip(words[::2], words[1::2], strict=False):
            try:
                found["rule" if word == "irule" else word] = float(number)
            except ValueError:
                raise DesireError(Diagnostic("compare-form")) from None
        if not found or 2 * len(found) != len(words) or not found.keys() <= {"rule", "DT", "ERMAX"}:
            raise DesireError(Diagnostic("compare-form"))
        rule = found.get("rule")
        return cls(None if rule is None else rule_numbered(rule).number, found.get("DT"), found.get("ERMAX"))

    def named(self, record: RunRecord) -> str:
        """Return a run's settings of those that change: `rule 3, DT 0.001`."""
        parts = [f"rule {record.rule}"] if self.rule is not None else []
        parts += [f"DT {record.dt:g}"] if self.dt is not None else []
        parts += [f"ERMAX {record.error_max:g}"] if self.error_max is not None else []
        return ", ".join(parts)


def compare_runs(
    workspace: Workspace,
    runs: Runs,
    graphs: GraphPages,
    change: Variation,
    show: Callable[[Graph], object],
) -> str:
    """Return a table: for each displayed variable the largest difference, its time, and the final values.

    Both runs are put on a page of their own, which `show` is given. Everything is put back
    afterwards: quantities, random numbers, positions of histories.
    """
    last = runs.kept[-1] if runs.kept else None
    if last is None:
        raise DesireError(Diagnostic("no-run"))
    if not last.columns or not last.count:
        raise DesireError(Diagnostic("compare-nothing"))
    program, _ = workspace.runnable()
    if runs.run_of != (program.source.text, workspace.values.generation):
        raise DesireError(Diagnostic("compare-changed"))
    with runs.restored():
        other = run_again(workspace, runs, last, change)
        sampled = _sampled_alike(workspace, runs, last, other, change)
    page = graphs.compare((last, other))
    if page is not None:
        show(page)
    return table(last, other, change.named, sampled)


def _sampled_alike(
    workspace: Workspace, runs: Runs, one: RunRecord, other: RunRecord, change: Variation
) -> tuple[RunRecord, RunRecord]:
    """Return the runs, or where their samples stand at different times one of them made again.

    A fixed step is never shortened and samples come a little late; a run of the other kind is then made with
    samples at all those steps. Not where anything but samples happens at communication points.
    """
    again = needs_steps_of(one, other)
    if again is None:
        return one, other
    program, script = workspace.runnable()
    segment = workspace.segments.lowered(program, script, one.segment, other.rule)
    if not is_pure(full_pass(segment)):
        return one, other
    repeated, spacing = again
    try:
        if repeated is one:
            return run_again(workspace, runs, one, Variation(), spacing), other
        return one, run_again(workspace, runs, one, change, spacing)
    except DesireError:
        return one, other  # the runs themselves ended well: their samples are compared as they are


def run_again(
    workspace: Workspace,
    runs: Runs,
    last: RunRecord,
    change: Variation,
    spacing: float | None = None,
    recorded: Sequence[tuple[str, int]] = (),
) -> RunRecord:
    """Run from where the last run began; with `spacing`, samples stand that far apart.

    The variables `recorded` (name, slot) are sampled too. Within `Runs.restored`.
    """
    is_exact = runs.start is not None
    runs.go_back()
    rule = last.rule if change.rule is None else change.rule
    program, script = workspace.runnable()
    segment = workspace.segments.lowered(program, script, last.segment, rule)
    if (rule == DUMMY) != (segment.order == 0):
        why = "has differential equations" if segment.order else "has no differential equations"
        raise DesireError(Diagnostic("compare-not-integrated", facts={"what": f"rule {rule}", "why": why}))
    if segment.recover:
        segment = workspace.segments.recovering(segment, workspace.stash_path("read", lambda _: False))
    if recorded:  # stashed variables are columns and nothing else
        more = (SampleColumn(name, slot, _anywhere(segment)) for name, slot in recorded)
        segment = replace(segment, stash=(*segment.stash, *more))
    for slot, value in ((DT, change.dt), (ERMAX, change.error_max)):
        if value is not None:
            workspace.values.assign(slot, value)
    plan = runs.simulator.defaults.plan(segment, rule, workspace.source, None)
    replaced = runs.simulator.defaults.warnings()
    if replaced:  # a comparison is of what was asked for, or of nothing
        raise DesireError(*(replace(problem, severity="error") for problem in replaced))
    segment = workspace.segments.directed(segment, plan)
    if spacing is not None:
        plan = plan.sampled_every(spacing)
    record = RunRecord(
        number=0, segment=last.segment, line=0, requests=segment.requests, columns=segment.columns,
        overlay=False, rule=plan.rule, scale=plan.scale, t0=plan.t0, t_max=plan.span, nn=plan.nn,
        dt=plan.dt, error_max=plan.tolerance, points=point_sets(segment, workspace.values),
    )  # fmt: skip
    if not is_exact:
        record.message = "compared with the quantities as they are now: of so large a model no copy is kept"
    try:
        finished = runs.simulator.run(
            workspace.segments.model_of(segment, plan), segment, plan, record, _NoObserver()
        )
    except DesireError as error:
        facts = {"setting": change.named(record), "reason": error.diagnostics[0].message}
        raise DesireError(Diagnostic("compare-failed", facts=facts)) from error
    if not finished:
        raise Interrupted
    return record


def _anywhere(segment: Segment) -> Where:
    """Return a place for what the program does not ask for, where an infinite value would be reported."""
    places = [*(states.where for states in segment.states), *(column.where for column in segment.columns)]
    return places[0] if places else Where(Span(0, 0))


class _NoObserver:
    def block(self, record: RunRecord, first_row: int) -> None:
        """Nobody watches this run."""
