"""Long sums and products in a segment: computed in pieces, so that no back end meets a deep expression.

`y = a + b + … + z` becomes `h = a + b + …`, `y = h + … + z`, with a number (vector, matrix) h of the
compiler's own. Operations and their order stay what they are, so the values do too.
"""

from __future__ import annotations

from math import prod
from typing import TYPE_CHECKING

from desire_tui.engine.left_chains import PIECE, chain, is_long
from desire_tui.engine.lowered.effects import count_draws
from desire_tui.engine.lowered.expressions import Const, Load, Op, Vec
from desire_tui.engine.lowered.statements import Set, SetMat, SetVec
from desire_tui.engine.lowering import products
from desire_tui.engine.lowering.calls import LEVELS_MOST, levels_of
from desire_tui.engine.lowering.lowering_context import BAD, UNKNOWN_SLOT
from desire_tui.engine.lowering.operators import OPERATIONS
from desire_tui.engine.lowering.scope import UNKNOWN

if TYPE_CHECKING:
    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowering.lowering_context import Extent, LoweringContext
    from desire_tui.engine.nodes.expressions import Binary, Expr


def lower_long(context: LoweringContext, node: Binary, extent: Extent) -> Value:
    """Return the value of a long sum or product. Error 401 where random numbers forbid pieces."""

    def keep(value: Value) -> Value:
        return _kept(context, node, value, extent)

    first, steps = chain(node)
    if extent and steps[0].op in "*/&":
        count = next((i for i, step in enumerate(steps) if step.op in "+-"), len(steps))
        result = products.product(context, steps[count - 1], extent, keep)
        steps = steps[count:]
    else:
        result = context.lower(first, extent)
        if is_long(first):
            result = keep(result)
    for number, step in enumerate(steps, 1):
        deep = is_long(step.right)
        if deep or number % PIECE == 0:
            result = keep(result)  # first, so that random numbers are drawn from left to right
        right = context.lower(step.right, extent)
        if deep:
            right = keep(right)
        if step.op == "&":
            return context.report("ampersand-here", step)
        result = Op(OPERATIONS[step.op], (result, right))
    return _bounded(context, node, result) if extent and count_draws(result) else result


def _kept(context: LoweringContext, node: Expr, value: Value, extent: Extent) -> Value:
    """Compute a value before the statement; return what reads it.

    Vectors and matrices that draw random numbers stay where they are: each element draws in its turn.
    """
    if isinstance(value, Const | Load | Vec):
        return value
    context.reads[""] = UNKNOWN_SLOT  # the statement's own part alone must not be cached
    if UNKNOWN in extent:
        return BAD  # a check before the run: nothing is computed
    if extent and count_draws(value):
        return _bounded(context, node, value)
    count, where = prod(extent), context.where(node)
    slot = context.scope.hidden(count)
    if not extent:
        context.computed_first.append(Set(slot, value, where))
        return Load(slot)
    if len(extent) == 1:
        context.computed_first.append(SetVec(slot, count, value, where))
    else:
        context.computed_first.append(SetMat(slot, extent[0], extent[1], value, where))
    return Vec(slot, count)


def _bounded(context: LoweringContext, node: Expr, value: Value) -> Value:
    """Return what cannot be cut into pieces. Error 401: it is too deep."""
    if levels_of(value) > LEVELS_MOST:
        return context.report("expression-too-deep", node, limit=LEVELS_MOST)
    return value
