"""Expressions that a study keeps of each run, compiled into the segment as if the program computed them.

They stand behind everything else in a pass, outside of every `if` and OUT, and are sampled with what the
program displays. Nothing else reads them, so passes at steps leave them out: they cost what a `dispt` costs.
"""

from __future__ import annotations

from copy import copy
from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.data_classes import replace
from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.lowered.segment import SampleColumn, SampleRequest
from desire_tui.engine.lowered.statements import Guard, Set, Where
from desire_tui.engine.lowered.walk import with_bodies
from desire_tui.engine.lowering.lowering import lower
from desire_tui.engine.nodes.assignments import Assign
from desire_tui.engine.nodes.program import Placed, SegmentText
from desire_tui.engine.source import Source, Span
from desire_tui.engine.syntax.parse import parse_command

if TYPE_CHECKING:
    from collections.abc import Container, Iterable, Sequence

    from desire_tui.engine.lowered.segment import Event, Segment
    from desire_tui.engine.lowered.statements import Action
    from desire_tui.engine.nodes.program import Program
    from desire_tui.engine.structure.structure import Structure
    from desire_tui.engine.values import Values


_NOWHERE = Where(Span(0, 0))


class Expression(NamedTuple):
    """An expression: its text and where that begins in the text the user gave."""

    text: str
    at: int


class KeptExpressions:
    """Expressions given in one text, for messages; `names` are those of their columns among the samples.

    DesireError: one of them is no expression, with its place in that text.
    """

    def __init__(self, given: Source, expressions: Sequence[Expression]) -> None:
        self._given = given
        self.names = tuple(f"kept${number}" for number in range(1, len(expressions) + 1))
        self._parsed = [
            self._assignment(name, each) for name, each in zip(self.names, expressions, strict=True)
        ]

    def _assignment(self, name: str, expression: Expression) -> Placed:
        head = f"{name} = "
        statements, problems = parse_command(Source(head + expression.text, self._given.name))
        if problems:
            raise DesireError(*(self._moved(p, expression.at - len(head)) for p in problems))
        if len(statements) != 1 or not isinstance(statements[0].node, Assign):
            span = Span(expression.at, expression.at + len(expression.text))
            facts = {
                "what": f"'{expression.text}' is no expression",
                "remedy": "one that could stand in a dispt",
            }
            raise DesireError(Diagnostic("study-form", span, facts, self._given))
        return statements[0]._replace(at=expression.at - len(head))

    def _moved(self, problem: Diagnostic, by: int) -> Diagnostic:
        """Place a problem of the text that was read in the text that was given."""
        span = problem.span
        if span is not None:
            start = min(max(span.start + by, 0), len(self._given.text))
            span = Span(start, max(min(span.end + by, len(self._given.text)), start))
        return replace(problem, span=span, source=self._given, related=())

    def lower(
        self, program: Program, label: str | None, values: Values, structure: Structure, rule: int
    ) -> Segment:
        """Return a segment that computes and samples them too. DesireError: the program's, or theirs.

        In a program of several segments, one that does not have what they need stays as it is.
        """
        text = program.segment(label)
        if text is None or not self.names:
            return lower(program, label, values, structure, rule)
        own = program.source
        behind = len(own.text) + 1
        together = replace(own, text=f"{own.text}\n{self._given.text}")
        added = tuple(placed._replace(at=placed.at + behind) for placed in self._parsed)
        longer = SegmentText(text.label, (*text.body, *added), text.jacobian, text.at)
        segments = tuple(longer if each is text else each for each in program.segments)
        try:
            made = lower(replace(program, source=together, segments=segments), label, values, structure, rule)
        except DesireError as error:
            theirs = [p for p in error.diagnostics if p.span is not None and p.span.start >= behind]
            others = [replace(p, source=own) for p in error.diagnostics if p not in theirs]
            if others or len(program.segments) == 1:
                placed = [*others, *(self._moved(p, -behind) for p in theirs)]
                raise DesireError(*placed) from None
            return lower(program, label, values, structure, rule)
        slots = {values.names[name].slot: name for name in self.names}
        found: dict[int, Set] = {}
        body = _without(made.body, slots.keys(), found)
        events = tuple(_replaced(event, _without(event.body, slots.keys(), found)) for event in made.events)
        columns = tuple(SampleColumn(name, slot, found[slot].where) for slot, name in slots.items())
        return replace(
            made, source=own, body=(*body, *found.values()), events=events,
            requests=_with_columns(made.requests, columns),
        )  # fmt: skip


def _replaced(event: Event, body: tuple[Action, ...]) -> Event:
    """Return an event that executes other statements."""
    return type(event)(body, event.where, event.condition, event.period, event.start)


def _without(actions: Iterable[Action], slots: Container[int], found: dict[int, Set]) -> tuple[Action, ...]:
    """Take the assignments of some slots out of statements, wherever they stand."""
    left: list[Action] = []
    for action in actions:
        if isinstance(action, Set) and action.slot in slots:
            alone = copy(action)
            alone.persistent = False  # type: ignore[misc]  # nodes are frozen for the type checker only
            alone.where = _NOWHERE  # type: ignore[misc]  # messages of the run show places of the program
            found[action.slot] = alone
        elif isinstance(action, Guard):
            body, orelse = _without(action.body, slots, found), _without(action.orelse, slots, found)
            if body or orelse:
                left.append(with_bodies(action, body, orelse))
        else:
            left.append(action)
    return tuple(left)


def _with_columns(
    requests: tuple[SampleRequest, ...], columns: tuple[SampleColumn, ...]
) -> tuple[SampleRequest, ...]:
    """Let the display request sample more; a segment without one gets one."""
    for number, request in enumerate(requests):
        if request.kind != "type":
            wider = SampleRequest(
                request.kind, (*request.columns, *columns), request.channel, request.where, request.points
            )
            return (*requests[:number], wider, *requests[number + 1 :])
    return (*requests, SampleRequest("dispt", columns))
