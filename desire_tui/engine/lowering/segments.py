"""A DYNAMIC program segment, lowered: the table of contents of this folder.

expansion (submodels in line) → states (numbered) → statements in order (expressions, arrays, requests,
learning) → persistence (flow) → `lowered.Segment`. All problems of the segment are found, not only the first.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, assert_never, get_args

from desire_tui.engine.cancellation import cancellation_point, handing_over
from desire_tui.engine.data_classes import replace
from desire_tui.engine.diagnostics import Diagnostic
from desire_tui.engine.integration.rules import RULES
from desire_tui.engine.lowered.effects import writes
from desire_tui.engine.lowered.expressions import Load
from desire_tui.engine.lowered.lazy_operations import new_record
from desire_tui.engine.lowered.segment import Segment, StateRange
from desire_tui.engine.lowered.statements import Guard
from desire_tui.engine.lowered.walk import walk_actions
from desire_tui.engine.lowering import (
    arrays,
    learning,
    lowering_cache,
    requests,
    statements,
    targets,
    written_lines,
)
from desire_tui.engine.lowering.builder import SegmentBuilder
from desire_tui.engine.lowering.calls import LEVELS_MOST
from desire_tui.engine.lowering.expressions import ExpressionLowering
from desire_tui.engine.lowering.jacobian import lower_jacobian
from desire_tui.engine.lowering.plain_lines import lower_plain_lines, scalar_states
from desire_tui.engine.lowering.recursions import recursions
from desire_tui.engine.lowering.scope import UNKNOWN, size_of
from desire_tui.engine.lowering.states import StateTable
from desire_tui.engine.lowering.submodels import expand
from desire_tui.engine.nodes.assignments import Assign, Bare, Dot, MatrixAssign, VectorAssign
from desire_tui.engine.nodes.commands import Simple
from desire_tui.engine.nodes.control import If
from desire_tui.engine.nodes.display import Request, Show, ShowArea
from desire_tui.engine.nodes.expressions import Element, Name
from desire_tui.engine.nodes.faulty import Faulty
from desire_tui.engine.nodes.lazy_parts import written_target
from desire_tui.engine.nodes.names import assigned
from desire_tui.engine.nodes.segment import (
    Delay,
    Derivative,
    Event,
    Every,
    Fast,
    FunctionTable,
    Get,
    Invoke,
    Learn,
    Sample,
    Store,
    Term,
    TrackHold,
    VectorDerivative,
)
from desire_tui.engine.nodes.statements import ScriptOnlyStatement, Statement
from desire_tui.engine.passes.noise import noisy_derivative
from desire_tui.engine.source import Span
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from desire_tui.engine.lowered.segment import Breakpoints
    from desire_tui.engine.lowered.statements import Action
    from desire_tui.engine.lowering.lowering_context import FunctionText, LoweringContext
    from desire_tui.engine.lowering.scope import SegmentScope
    from desire_tui.engine.lowering.submodels import Line
    from desire_tui.engine.nodes.program import SegmentText
    from desire_tui.engine.source import Source
    from desire_tui.engine.structure.structure import Structure

_ASSIGN_NOTHING_IN_A_PASS = frozenset({Derivative, VectorDerivative, *get_args(ScriptOnlyStatement)})
"""States change between passes, statements of the script are refused."""


def lower_segment(
    text: SegmentText,
    scope: SegmentScope,
    source: Source,
    functions: Mapping[str, FunctionText],
    structure: Structure,
    rule: int | None = None,
) -> tuple[Segment, list[Diagnostic]]:
    """Return the lowered segment and every problem found in it."""
    submodels, faults = structure.submodels, structure.faults
    lowering_cache.age()
    written_lines.age()
    context = ExpressionLowering(scope, source, functions)
    context.reads_as_written = not (submodels or context.redefines_library)
    lines = expand(context, text.body, submodels)
    jacobian_lines = expand(context, text.jacobian, submodels)
    if faults:
        lines, jacobian_lines = _sound(context, lines, faults), _sound(context, jacobian_lines, faults)
    _collect_targets(context, lines)
    _collect_targets(context, jacobian_lines)
    builder = SegmentBuilder(context, _states(context, lines), rule)
    context.rule = rule if builder.states.ranges else 0
    _ready_from_start(builder, lines)
    ranges = builder.states.ranges
    if ranges and ("t" in context.assigned or "t" in [states.name for states in ranges]):
        _refuse_to_set_time(context, [*lines, *jacobian_lines])
    with handing_over(context.problems, lambda: context.span(node).start):
        done = 0
        while (done := lower_plain_lines(builder, lines, done)) < len(lines):
            node, frame = lines[done]
            done += 1
            context.enter(frame)
            cancellation_point()
            outer, place = builder.body, len(builder.body)
            try:
                _lower_statement(builder, node)
            except RecursionError:
                context.enter(frame)
                context.report("expression-too-deep", node, limit=LEVELS_MOST)
            if context.row_read is not None:
                builder.watch_row(context.row_read)
                context.row_read = None
            if context.computed_first:
                if isinstance(node, Event | Every) and builder.at_moment:
                    outer = builder.guards[-1].outer  # not in the block that ends here
                    place = len(outer)
                elif builder.at_moment and any(
                    isinstance(action, Guard) for action in context.computed_first
                ):
                    context.report("not-at-moment", node, word="white")
                outer[place:place] = context.computed_first
                context.computed_first.clear()
    body = builder.finish()
    jacobian = lower_jacobian(builder, jacobian_lines) if jacobian_lines else None
    context.flow.mark_persistent([(r.slot, r.count) for r in builder.states.ranges])
    segment = Segment(
        label=text.label, source=source, body=body, states=tuple(builder.states.ranges),
        requests=tuple(builder.requests), pictures=tuple(builder.pictures),
        stash=tuple(builder.stash), recover=tuple(builder.recover), jacobian=jacobian,
        counters=builder.counters, scalars=_scalars(context), names=builder.names,
        faults=tuple(builder.faults), levels=tuple(builder.levels), row_chosen=context.row_chosen,
        breakpoints=_filled_by_script(context.breakpoints, body), events=tuple(builder.events),
        delays=tuple(context.delays), may_rearrange=builder.may_rearrange,
    )  # fmt: skip
    warnings = [*_noise(context, segment), *recursions(segment, scope)]
    return replace(segment, warnings=tuple(warnings)), context.problems


def _noise(context: LoweringContext, segment: Segment) -> Iterator[Diagnostic]:
    """Warn where derivatives read random numbers. Error 489 under a rule that tests its steps."""
    text = context.source.text
    if not segment.states or not ("ran" in text or "gauss" in text):  # the search takes its time
        return
    noise = noisy_derivative(segment)
    if noise is None:
        return
    rule = context.rule
    if rule is not None and rule in RULES and RULES[rule].controls_error:
        context.add(Diagnostic("noise-under-rule", noise.span, {"rule": rule}, context.source))
    else:
        yield Diagnostic("noise-in-step", noise.span, {}, context.source, "warning")


def _sound(context: LoweringContext, lines: list[Line], faults: Mapping[int, Diagnostic]) -> list[Line]:
    """Return the lines that can be lowered; what is wrong with the others is noted."""
    for _, frame in lines:
        if frame.at in faults:
            context.enter(frame)
            context.add(faults[frame.at])
    return [line for line in lines if line[1].at not in faults]


_NOT_AT_MOMENTS = (Derivative, VectorDerivative, Store, Get, Delay, Term)


def _lower_statement(builder: SegmentBuilder, node: Statement) -> None:
    if builder.guards and isinstance(node, _NOT_AT_MOMENTS) and builder.at_moment:
        context = builder.context
        word = context.source.word(context.span(node).start)
        context.report("not-at-moment", node, word="d/dt" if word == "d" else word)
        builder.end_moment()
    match node:
        case Assign():
            return statements.assign(builder, node)
        case Derivative():
            return statements.derivative(builder, node)
        case VectorAssign():
            return arrays.vector_assign(builder, node)
        case VectorDerivative():
            return arrays.vector_derivative(builder, node)
        case MatrixAssign():
            return arrays.matrix_assign(builder, node)
        case Dot():
            return arrays.dot(builder, node)
        case Store():
            return statements.store(builder, node)
        case Get():
            return statements.get(builder, node)
        case Delay():
            return statements.delay(builder, node)
        case TrackHold():
            return statements.track_hold(builder, node)
        case FunctionTable():
            return statements.table(builder, node)
        case Term():
            return statements.term(builder, node)
        case If():
            return statements.condition(builder, node)
        case Simple():
            return statements.simple(builder, node)
        case Sample():
            return statements.sample(builder, node)
        case Event():
            return statements.event(builder, node)
        case Every():
            return statements.every(builder, node)
        case Fast():
            builder.may_rearrange = True
            return None
        case Request():
            return requests.request(builder, node)
        case ShowArea():
            builder.by_size = node.by_size
            return None
        case Show():
            return requests.show(builder, node)
        case Learn():
            return learning.learn(builder, node)
    if isinstance(node, ScriptOnlyStatement | Bare | Invoke):  # calls of submodels have been expanded
        context = builder.context
        word = context.source.word(context.span(node).start)
        context.report("illegal-in-dynamic", node, word=word)
        return None
    assert not isinstance(node, Faulty)  # those were left out
    assert_never(node)


def _collect_targets(context: LoweringContext, lines: Sequence[Line]) -> None:
    """Note where each scalar of the segment is first assigned, and whether arrays are."""
    for node, frame in [line for line in lines if type(line[0]) not in _ASSIGN_NOTHING_IN_A_PASS]:
        known = written_target(node)
        if known is not None:
            name = frame.rename.get(known, known)
            if name not in context.assigned:
                context.assigned[name] = (Span(frame.at + node.start, frame.at + node.end),)
                context.scope.scalar(name)
            continue
        cancellation_point()
        found = assigned(node)
        if found.arrays:
            context.assigned_arrays = True
        if found.targets:
            context.enter(frame)
        for target in found.targets:
            if isinstance(target, Element):
                context.assigned_arrays = True
                continue
            name = frame.rename.get(target.name, target.name)
            if name not in context.assigned:
                context.assigned[name] = (context.span(node),)
                context.scope.scalar(name)


def _refuse_to_set_time(context: LoweringContext, lines: Sequence[Line]) -> None:
    """Report what would move t while states are integrated over it: such a run may never end."""
    for node, frame in lines:
        if isinstance(
            node, Request | ScriptOnlyStatement
        ):  # `recover t` puts back what was stashed at the same point
            continue
        context.enter(frame)
        for target in assigned(node).targets:
            if isinstance(target, Name) and frame.rename.get(target.name, target.name) == "t":
                context.report("time-as-target", target)


def _states(context: LoweringContext, lines: Sequence[Line]) -> StateTable:
    plain = scalar_states(context, lines) if context.reads_as_written else None
    if plain is not None:
        return StateTable(plain)
    found: list[StateRange] = []
    for node, frame in lines:
        cancellation_point()
        if isinstance(node, Derivative):
            context.enter(frame)
            target = node.target
            if isinstance(target, Name):
                name = frame.rename.get(target.name, target.name)
                known = context.scope.names.get(name)
                if known is None or not known.shape:
                    if known is None or not known.is_state:
                        known = context.scope.scalar(name, is_state=True)
                    slot = known.slot
                    found.append(StateRange(name, slot, len(found), 1, context.where(node)))
            else:
                found.extend(_element_state(context, node, target, len(found)))
        elif isinstance(node, VectorDerivative):
            context.enter(frame)
            quantity = context.quantity(node.name)
            if quantity is not None and quantity.shape and (count := size_of(quantity)) != UNKNOWN:
                quantity.is_state = True
                where = context.where(node)
                found.append(StateRange(quantity.name, quantity.slot, len(found), count, where))
    return StateTable(found)


def _element_state(
    context: LoweringContext, node: Derivative, target: Element, number: int
) -> list[StateRange]:
    # problems of the subscripts are reported when the statement itself is lowered
    known, reported = len(context.problems), set(context.reported)
    slot = targets.scalar_slot(context, target)
    del context.problems[known:]
    context.reported = reported
    quantity = context.quantity(target.name)
    if slot is None or quantity is None:
        return []
    quantity.is_state = True
    first = slot - quantity.slot
    subscripts = []
    for size in reversed(quantity.shape):
        subscripts.append(first % size + 1)
        first //= size
    name = f"{quantity.name}[{','.join(str(s) for s in reversed(subscripts))}]"
    return [StateRange(name, slot, number, 1, context.where(node))]


def _ready_from_start(builder: SegmentBuilder, lines: Sequence[Line]) -> None:
    """States that are not assigned, t, and recovered variables can be read anywhere."""
    context = builder.context
    ready = context.flow.ready
    if "t" not in context.assigned:
        ready["t"] = Load(T)
    states = [s for s in builder.states.ranges if s.count == 1 and s.name not in context.assigned]
    names, slots = [state.name for state in states], [state.slot for state in states]
    for name, slot in zip(names, slots, strict=True):
        load: Load = new_record(Load)  # a third of the time of its constructor
        load.slot = slot  # type: ignore[misc]  # frozen for the type checker only
        ready[name] = load
    builder.names.update(zip(slots, names, strict=True))
    for node, frame in [line for line in lines if type(line[0]) is Request]:
        if isinstance(node, Request) and node.kind == "recover":
            context.enter(frame)
            for item in node.items:
                targets.mark_held(context, item)


def _filled_by_script(found: list[Breakpoints], body: tuple[Action, ...]) -> tuple[Breakpoints, ...]:
    """Return the breakpoints that the segment itself does not set."""
    if not found:
        return ()
    written = [interval for action in walk_actions(body) for interval in writes(action)]
    return tuple(
        points
        for points in found
        if not any(slot < points.slot + points.count and points.slot < slot + n for slot, n in written)
    )


def _scalars(context: LoweringContext) -> tuple[int, ...]:
    found = (context.scope.names.get(name) for name in context.assigned)
    return tuple(q.slot for q in found if q is not None and not q.shape)
