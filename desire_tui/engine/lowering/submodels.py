"""Submodels are expanded in line: their dummies stand for the invocation's arguments (language.md 9.6)."""

from __future__ import annotations

from itertools import repeat
from typing import TYPE_CHECKING

from desire_tui.engine.cancellation import cancellation_point
from desire_tui.engine.diagnostics import closest
from desire_tui.engine.library import LIBRARY
from desire_tui.engine.lowering.lowering_context import DEPTH_MAX, ExpansionFrame
from desire_tui.engine.nodes.assignments import Bare
from desire_tui.engine.nodes.expressions import Element, Name
from desire_tui.engine.nodes.names import invocation
from desire_tui.engine.nodes.segment import Invoke
from desire_tui.engine.quick_tuples import tuples
from desire_tui.engine.structure.expanded_lines import LINES_MOST, expanded_lines

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from desire_tui.engine.lowering.lowering_context import LoweringContext
    from desire_tui.engine.nodes.expressions import Expr
    from desire_tui.engine.nodes.program import Placed
    from desire_tui.engine.nodes.statements import Statement
    from desire_tui.engine.structure.structure import SubmodelText

Line = tuple["Statement", ExpansionFrame]
_INVOKING = frozenset({Invoke, Bare})
"""Kinds of statements that may be invocations (`nodes.names.invocation`)."""


def expand(
    context: LoweringContext, statements: Sequence[Placed], submodels: Mapping[str, SubmodelText]
) -> list[Line]:
    """Return the statements with every invocation replaced by its body. Errors 201, 56, 52, 209."""
    kinds = {type(placed.node) for placed in statements}
    if kinds.isdisjoint(_INVOKING):
        cancellation_point()
        places = [placed.at for placed in statements]
        frames = tuples(ExpansionFrame, places, *map(repeat, ExpansionFrame(0)[1:]))
        return list(zip([placed.node for placed in statements], frames, strict=True))
    lines: list[Line] = []
    expanded = expanded_lines(submodels) if submodels else {}
    total = 0
    for statement, at, _ in statements:
        cancellation_point()
        frame, invoked = ExpansionFrame(at), invocation(statement)
        total += 1
        if invoked is None:
            lines.append((statement, frame))
            continue
        context.frame = frame
        total += expanded.get(invoked[0], 0)
        if total > LINES_MOST:
            if context.first_report("SUBMODEL expansions"):
                context.report("too-many-lines", statement, name=invoked[0], most=LINES_MOST)
        else:
            _invoke(context, statement, *invoked, submodels, lines)
    return lines


def _invoke(
    context: LoweringContext,
    node: Statement,
    name: str,
    args: tuple[Expr, ...],
    submodels: Mapping[str, SubmodelText],
    lines: list[Line],
) -> None:
    frame = context.frame
    submodel = submodels.get(name)
    if submodel is None:
        key = "undefined-submodel"
        if name in context.functions or name in LIBRARY:
            key = "function-as-statement"
        elif name in ("event", "every"):
            key = "moment-without-blank"
        elif isinstance(node, Bare) and isinstance(node.value, Element):
            key = "expression-alone"
        context.report(key, node, name=name, close=closest(name, submodels))
        return
    if f"SUBMODEL {name}" in context.reported:
        return  # it invokes itself, which was said: its bodies may have any number of lines
    if name in frame.calls or len(frame.calls) > DEPTH_MAX:
        context.reported.add(f"SUBMODEL {name}")
        if name in frame.calls:
            context.report("submodel-recursion", node, name=name)
        else:
            context.report("submodels-too-deep", node, limit=DEPTH_MAX)
        return
    if len(args) != len(submodel.dummies):
        context.report("submodel-arguments", node, name=name, wanted=len(submodel.dummies), given=len(args))
        return
    rename: dict[str, str] = {}
    for dummy, argument in zip(submodel.dummies, args, strict=True):
        if isinstance(argument, Name):
            rename[dummy] = frame.rename.get(argument.name, argument.name)
        else:
            context.report("submodel-argument-not-name", argument, name=name)
            return
    invoked = (*frame.invoked, context.span(node))
    calls = (*frame.calls, name)
    for statement, at, _ in submodel.body:
        inner = ExpansionFrame(at, rename, {}, invoked, calls)
        context.frame = inner
        inner_invocation = invocation(statement)
        if inner_invocation is None:
            lines.append((statement, inner))
        else:
            _invoke(context, statement, *inner_invocation, submodels, lines)
    context.frame = frame
