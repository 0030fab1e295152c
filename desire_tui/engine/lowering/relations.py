"""Relations where a value is expected: 1 or 0, by the switching functions of the library.

`a > b` is `swtch(a - b)`: whatever knows where a switching function jumps, and that its derivative is 0,
knows it of relations too.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, assert_never

from desire_tui.engine.lowered.expressions import Const, Op
from desire_tui.engine.nodes.expressions import Logical, Not, Relation

if TYPE_CHECKING:
    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowering.lowering_context import Extent, LoweringContext
    from desire_tui.engine.nodes.expressions import Condition


def truth(context: LoweringContext, condition: Condition, extent: Extent) -> Value:
    """Return 1 where a condition holds, else 0; nan where nan is compared."""
    match condition:
        case Relation(op, left, right):
            return _relation(op, context.lower(left, extent), context.lower(right, extent))
        case Logical(op, first, second):
            both = truth(context, first, extent), truth(context, second, extent)
            return Op("mul" if op == "and" else "max", both)
        case Not(operand):
            return _opposite(truth(context, operand, extent))
    assert_never(condition)


def _relation(op: str, a: Value, b: Value) -> Value:
    match op:
        case ">":
            return Op("swtch", (Op("sub", (a, b)),))
        case "<":
            return Op("swtch", (Op("neg", (Op("sub", (a, b)),)),))
        case "<=":
            return _opposite(_relation(">", a, b))
        case ">=":
            return _opposite(_relation("<", a, b))
        case "=":
            return _opposite(_relation("<>", a, b))
        case _:
            return Op("abs", (Op("sgn", (Op("sub", (a, b)),)),))


def _opposite(value: Value) -> Value:
    return Op("sub", (Const(1.0), value))
