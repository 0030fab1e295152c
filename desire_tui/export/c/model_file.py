"""One C99 file for a run: its numbers, its passes, the rule, a `main` that writes the samples as CSV."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.integration.rules import DUMMY, RULES
from desire_tui.engine.integration.tableaus import TABLEAUS
from desire_tui.engine.lowered.statements import LearningStep
from desire_tui.engine.lowered.walk import simple_actions
from desire_tui.engine.passes.assigned_states import checked_state, stepped_segment
from desire_tui.engine.passes.point_effects import may_pass_points
from desire_tui.engine.passes.renewal import renewals
from desire_tui.engine.passes.slices import derivative_slice, final_sample_pass, full_pass, step_slice
from desire_tui.engine.passes.switching import switching
from desire_tui.engine.values import DT, ERRMAX, T
from desire_tui.export.c.frame import LOOP_OF_POINTS, MAIN, ModelParts, sample
from desire_tui.export.c.functions import definitions
from desire_tui.export.c.layout import Layout
from desire_tui.export.c.statements import Statements

if TYPE_CHECKING:
    from collections.abc import Iterator

    from desire_tui.engine.integration.tableaus import Tableau
    from desire_tui.export.run import ExportedRun


class ModelFile:
    """The parts of the file. DesireError 530: all that C does not have here, each with its line."""

    def __init__(self, run: ExportedRun) -> None:
        self.run = run
        whole = run.segment
        self.rule = run.plan.rule if whole.order else DUMMY
        kind = RULES[self.rule].kind
        problems = list(_refused(run, self.rule))
        if problems:
            raise DesireError(*problems)
        self.segment, numbers = stepped_segment(whole, run.values.room, variable=kind == "variable")
        self.checked = checked_state(run.plan.checked, numbers)
        self.tableau: Tableau | None = TABLEAUS.get(self.rule) if whole.order else None
        self.layout = Layout(run.values)
        self.statements = Statements(self.layout, run.lags)
        self.slots = [slot for r in self.segment.states for slot in range(r.slot, r.slot + r.count)]
        for r in self.segment.states:
            self.layout.offset(r.slot, r.count)

    @property
    def renews(self) -> bool:
        """Whether derivatives are made anew behind a step's start."""
        return self.has_variable_steps and bool(renewals(self.segment)[1])

    @property
    def has_variable_steps(self) -> bool:
        """Whether the rule controls its step."""
        return self.tableau is not None and self.tableau.variable

    def passes(self) -> str:
        """Return the passes as functions."""
        segment, function = self.segment, self.statements.function
        found = [function("full_pass", full_pass(segment))]
        if self.tableau is None:
            return "\n".join(found)
        found += [
            function("step_pass", step_slice(segment)),
            function("derivative_pass", derivative_slice(segment)),
            function("final_pass", final_sample_pass(segment)),
        ]
        if self.has_variable_steps:
            point, step = renewals(segment)
            found.append(function("renewal_pass", point))
            if step:
                found.append(function("step_renewal_pass", step))
        return "\n".join(found)

    def text(self) -> str:
        """Return the file."""
        passes = self.passes()
        columns = [(column.name, self.layout.place(column.slot)) for column in self.segment.columns]
        library = definitions(self.statements.used)
        for slot in (T, DT, ERRMAX):
            self.layout.place(slot)
        parts = ModelParts(
            self.run, self.rule, self.tableau, self.layout, frozenset(self.statements.used),
            tuple(self.slots), self.checked, self.renews, self.segment.counters,
        )  # fmt: skip
        loop = LOOP_OF_POINTS if self.tableau is None else parts.loop()
        pieces = [
            parts.heading(), f"{self.layout.macros()}\n", parts.state_of_run(), library, passes,
            parts.integration(), sample(columns), loop, MAIN,
        ]  # fmt: skip
        return "\n".join(filter(None, pieces))


def _refused(run: ExportedRun, rule: int) -> Iterator[Diagnostic]:
    """Yield what is in the run that the file cannot do."""
    segment = run.segment

    def problem(what: str, remedy: str, where: object = None) -> Diagnostic:
        span = getattr(where, "span", None)
        return Diagnostic(
            "export-refused", span, {"what": what, "format": "C", "remedy": remedy}, segment.source
        )

    if segment.order and rule not in TABLEAUS:
        yield problem(f"irule {rule} ({RULES[rule].name})", "irule 3, or another of the rules 1 to 8")
    if run.plan.is_free and may_pass_points(segment):
        remedy = "DTMAX no more than COMINT, TMAX/(NN - 1): steps then end on communication points"
        yield problem(f"irule {rule} with steps beyond communication points", remedy)
    if run.plan.backward:
        yield problem("a run backward (TMAX below 0)", "a run forward")
    for event in segment.events:
        word = "event" if event.condition is not None else "every"
        yield problem(f"'{word}'", "the same at steps: 'step' and 'if'", event.where)
    for delayed in segment.delays:
        yield problem("delay(x, tau)", "tdelay, whose buffer is declared", delayed.where)
    for action in simple_actions(segment.body):
        if isinstance(action, LearningStep):
            yield problem(action.kind, "write its lines out", action.where)
    if segment.order and rule in TABLEAUS and RULES[rule].kind == "variable" and not segment.events:
        _, found = switching(segment, run.values.room)
        if found is not None:
            yield problem(
                f"a switch that irule {rule} locates", "irule 3 with a small DT, which steps over it"
            )
