"""Calls in a segment: library functions, tables, and FUNCTIONs, which are expanded where they are called."""

from __future__ import annotations

from itertools import chain
from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import closest
from desire_tui.engine.library import LIBRARY
from desire_tui.engine.lowered.expressions import Op, Table1, Table2
from desire_tui.engine.lowered.segment import Breakpoints
from desire_tui.engine.lowered.walk import operands
from desire_tui.engine.lowering.delayed import delayed
from desire_tui.engine.lowering.lowering_context import (
    BAD,
    DEPTH_MAX,
    EXPANSIONS_MOST,
    UNKNOWN_SLOT,
    Argument,
    ExpansionFrame,
)
from desire_tui.engine.lowering.noise import white
from desire_tui.engine.lowering.operators import COMPOSED
from desire_tui.engine.lowering.scope import UNKNOWN, agree, size_of
from desire_tui.engine.nodes.expressions import Call, Name
from desire_tui.engine.random_sequence import DRAWS
from desire_tui.engine.values import Kind, Quantity

if TYPE_CHECKING:
    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowering.lowering_context import Extent, LoweringContext
    from desire_tui.engine.nodes.expressions import Expr

LEVELS_MOST = 200
"""Levels of an expression with its FUNCTIONs expanded; later stages follow them recursively."""


def call(context: LoweringContext, node: Call, extent: Extent) -> Value:
    """Lower a call. Errors 59 (unknown), 56 (arguments), 52 (recursion), and those of the arguments."""
    if node.name in context.functions:
        return _expanded(context, node, extent)
    entry = LIBRARY.get(node.name)
    if entry is None:
        known = chain(context.functions, (n for n, f in LIBRARY.items() if "D" in f.where))
        close = closest(node.name, known)
        return context.report("unknown-function-in-dynamic", node, name=node.name, close=close)
    if "D" not in entry.where:
        return context.report("script-function", node, name=node.name)
    if not entry.fewest <= len(node.args) <= entry.most:
        return context.report(
            "library-arguments", node, name=node.name, parameters=entry.parameters, given=len(node.args)
        )
    if node.name == "func1":
        return table1(context, node, extent)
    if node.name == "func2":
        return table2(context, node, extent)
    if node.name in DRAWS:
        return Op(node.name, ())
    if entry.kind == "noise":
        return white(context, node, extent)
    if entry.kind == "history":
        return delayed(context, node, extent)
    args = tuple([context.lower(argument, extent) for argument in node.args])
    composed = COMPOSED.get(node.name)
    return Op(node.name, args) if composed is None else composed(*args)


def _expanded(context: LoweringContext, node: Call, extent: Extent) -> Value:
    context.reads[""] = UNKNOWN_SLOT
    function = context.functions[node.name]
    dummies = function.node.dummies
    frame = context.frame
    if node.name in frame.calls:
        return context.report("function-recursion", node, name=node.name)
    if len(frame.calls) > DEPTH_MAX:
        return context.report("functions-too-deep", node, limit=DEPTH_MAX)
    if len(dummies) != len(node.args):
        return context.report(
            "function-arguments", node, name=node.name, wanted=len(dummies), given=len(node.args)
        )
    context.expansions += 1
    if context.expansions > EXPANSIONS_MOST:
        if context.first_report("FUNCTION expansions"):
            context.report("too-many-expansions", node, name=node.name, most=EXPANSIONS_MOST)
        return BAD
    arguments = {d: Argument(a, frame) for d, a in zip(dummies, node.args, strict=True)}
    invoked, called = (*frame.invoked, context.span(node)), (*frame.calls, node.name)
    context.enter(ExpansionFrame(function.at, {}, arguments, invoked, called))
    value = context.lower(function.node.body, extent)
    context.enter(frame)
    if not frame.calls and levels_of(value) > LEVELS_MOST:
        return context.report("expression-too-deep", node, limit=LEVELS_MOST)
    return value


def levels_of(value: Value) -> int:
    """Return how deep an expression is; parts that stand at several places are looked at once."""
    depth: dict[int, int] = {}
    rest = [value]
    while rest:
        part = rest[-1]
        inner = operands(part)
        missing = [a for a in inner if id(a) not in depth]
        if missing and id(part) not in depth:
            rest.extend(missing)
        else:
            depth[id(part)] = 1 + max((depth[id(a)] for a in inner), default=0)
            rest.pop()
    return depth[id(value)]


def _array(context: LoweringContext, node: Expr) -> Quantity | None:
    """Return the array a table function's argument names. Errors 36, 19."""
    context.reads[""] = UNKNOWN_SLOT
    if not isinstance(node, Name):
        context.report("table-not-a-name", node)
        return None
    quantity = context.quantity(node.name)
    if quantity is None or not quantity.shape or quantity.kind is not Kind.REAL:
        arrays = (q.name for q in context.scope.names.values() if q.shape)
        name = context.actual(node.name)
        context.report("array-not-declared", node, name=name, close=closest(name, arrays))
        return None
    size = size_of(quantity)
    if size != UNKNOWN:
        context.flow.read_range(quantity.slot, size)
    return quantity


def table1(context: LoweringContext, node: Call, extent: Extent) -> Value:
    """Lower `func1(x; F)`: F is a vector of 2n elements, breakpoints first."""
    x = context.lower(node.args[0], extent)
    table = _array(context, node.args[1])
    if table is None:
        return BAD
    size = size_of(table)
    if size != UNKNOWN and (size % 2 or size < 2):
        return context.report("table-size", node.args[1], name=table.name, size=size)
    context.breakpoints.append(Breakpoints(table.name, table.slot, size // 2, context.where(node.args[1])))
    return Table1(x, table.slot, size // 2)


def table2(context: LoweringContext, node: Call, extent: Extent) -> Value:
    """Lower `func2(x, y; F, X, Y)`: F[n, m] over X[n] and Y[m]."""
    x = context.lower(node.args[0], extent)
    y = context.lower(node.args[1], extent)
    f, xs, ys = (_array(context, argument) for argument in node.args[2:])
    if f is None or xs is None or ys is None:
        return BAD
    if len(f.shape) != 2 or not (agree(f.shape[0], size_of(xs)) and agree(f.shape[1], size_of(ys))):
        return context.report("table2-size", node, f=f.name, x=xs.name, y=ys.name)
    for points, argument in ((xs, node.args[3]), (ys, node.args[4])):
        context.breakpoints.append(
            Breakpoints(points.name, points.slot, size_of(points), context.where(argument))
        )
    return Table2(x, y, f.slot, f.shape[0], f.shape[1], xs.slot, ys.slot)
