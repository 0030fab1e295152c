"""Expressions of a lowered segment, over one extent: a number, a vector, a matrix."""

from __future__ import annotations

from typing import Literal

from desire_tui.engine.lowered.lazy_operations import LazyOperands
from desire_tui.engine.nodes.record import node


@node
class Const:
    """A number."""

    value: float


@node
class Load:
    """The scalar (or array element) in a slot. `t` is slot 0."""

    slot: int


@node
class Op(LazyOperands):
    """An operation, elementwise over vectors.

    `name`: `add sub mul div neg`, `pow` (general power), `ipow` (second argument a whole `Const`: repeated
    products, binary powering from the top bit, negative n as 1/x^|n|), or a library function of language.md
    4.1: `sin cos tan asin acos atan sinh cosh tanh exp sqrt abs ln log atan2 lim sat SAT deadz deadc swtch
    sgn comp rect tri sinc sigmoid SIGMOID round trnc floor recip max min ran gauss`
    (`ran` and `gauss` have no arguments here).
    """

    name: str
    args: tuple[Value, ...]


@node
class Table1:
    """`func1`: breakpoints in `slot … slot+count-1`, values in the next `count` slots."""

    x: Value
    slot: int
    count: int


@node
class Table2:
    """`func2`, bilinear, constant outside: F is rows × cols, X has `rows`, Y `cols` elements."""

    x: Value
    y: Value
    f_slot: int
    rows: int
    cols: int
    x_slot: int
    y_slot: int


@node
class Vec:
    """A whole array as a vector (or matrix) of `count` elements."""

    slot: int
    count: int


@node
class ShiftedVec:
    """Element i is element i + `by` of the vector, 0 outside."""

    slot: int
    count: int
    by: int


@node
class MatVec:
    """`A * x` (`rows` elements; A is rows × cols) or, `transposed`, `A% * x` (`cols` elements)."""

    slot: int
    rows: int
    cols: int
    transposed: bool
    x_slot: int


@node
class PatternRow:
    """Row ((trnc(iRow) - 1) mod rows) + 1 of a matrix; error 124 is the runtime's business."""

    slot: int
    rows: int
    cols: int


@node
class Outer:
    """Matrix of `u[i] * v[k]` (`mul`) or `min(u[i], v[k])` (`min`)."""

    op: Literal["mul", "min"]
    u_slot: int
    u_count: int
    v_slot: int
    v_count: int


ElementOperand = Vec | ShiftedVec | MatVec | PatternRow | Outer
"""Operands that have one number for each element."""

Value = Const | Load | Op | Table1 | Table2 | ElementOperand
