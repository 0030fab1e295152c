"""The series that a derivative pass is made of."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from desire_tui.engine.data_classes import dataclass, field

if TYPE_CHECKING:
    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.statements import Action

Kind = Literal[
    "state", "time", "raised", "add", "sub", "neg", "times", "plus_times", "over", "mul", "div", "sqrt",
    "integral", "quotient", "power", "select", "shift", "product", "total", "element", "gather",
]  # fmt: skip
"""How the k-th coefficient u_k, k ≥ 1, follows; a, b are the operands:

    state     f_{k-1} / k with its derivative f           time      1, 0, 0 …
    raised    a_k: a and a constant added                 neg       -a_k
    add, sub  a_k ± b_k                                   times     a_k · constant
    plus_times  a_k + b_k · constant
    over      a_k / constant                              mul       Σ a_j b_{k-j}
    div       u = a / b (a may be constant)               sqrt      u² = a
    integral  u' = a · b'                                 quotient  u' = a' / b
    power     a · u' = b · u · a' with a constant b
    select    a where the constant is above 0, else b     shift     element i is element i + `by` of a
    product   a constant matrix times a                   total     the sum of a's elements
    element   a's element number `by`                     gather    elements of several series, one each
"""


SAMPLED, NEVER_INSIDE = -1, -2
"""In place of the number of an event's series: it has none; it never comes inside a step (clocks, conditions
that depend on t alone, which steps end at)."""


@dataclass(frozen=True, eq=False, slots=True)
class Constant:
    """What stays as it is while a step lasts: `value` is computed when the step begins.

    `slot`: where, None if nothing has asked for it there. `count` is None for a number.
    """

    value: Value
    slot: int
    count: int | None


@dataclass(eq=False, slots=True)
class Series:
    """A number (`count` None) or an array whose Taylor coefficients are computed in each step.

    `slot`: where coefficient 0 stands among the values. `by`: see `Kind`. `matrix` of a product: its slot,
    rows, columns, whether it is transposed. `lanes` of a gather: each element's operand, which element of it.
    `slots`: where elements' values stand if they are not neighbours (`grouping`); then `slot` says nothing.
    """

    number: int
    kind: Kind
    slot: int
    count: int | None
    operands: tuple[Series | Constant, ...]
    by: int = 0
    matrix: tuple[int, int, int, bool] | None = None
    lanes: tuple[tuple[Series | Constant, int], ...] = ()
    slots: tuple[int, ...] = ()

    @property
    def size(self) -> int:
        """Number of elements."""
        return 1 if self.count is None else self.count


Operand = Series | Constant


@dataclass(frozen=True)
class StatePiece:
    """States with one derivative: numbers `first` … `first` + `count` - 1 of all."""

    series: Series
    first: int
    count: int
    derivative: Operand


@dataclass(frozen=True)
class SeriesProgram:
    """What a step computes.

    `values_pass` puts all constants and coefficients 0 into their slots, from t, states and parameters.
    `nodes` come behind their operands, except for an integral's first. `arguments` are those of the segment's
    modes, one for each element, in their order (`lowered.switching`), `mode_count` of them, then conditions'.
    `conditions` has for each event which argument is its condition's, or what there is in place of one.
    """

    values_pass: tuple[Action, ...]
    nodes: tuple[Series, ...]
    states: tuple[StatePiece, ...]
    arguments: tuple[tuple[Operand, int], ...] = field(default=())
    mode_count: int = 0
    conditions: tuple[int, ...] = ()
