"""A DYNAMIC segment ready for any back end: names are slots, everything is expanded, shapes are checked.

Made by `analysis`, run by `codegen` (native) and `reference` (NumPy). Two back ends that follow the words
below give the same numbers.

**Expressions** are values over one *extent*: a scalar, n elements of a vector, or rows × cols of a matrix
(row-major). Scalars broadcast. An expression object that occurs twice in a statement (a FUNCTION's
argument) is evaluated **once**: compare by identity; met again in another statement, it is evaluated there
anew. Operands are evaluated left to right, which fixes the order of random draws; vector and matrix elements
are assigned from the last index to the first, each drawing as it comes.

**Statements** run in order. `Guard` holds statements that run only at some passes (language.md 9.1); which
statements a pass with given flags executes is `analysis.slices`. The states' own slots hold the states of
the present stage; a `Set` of a state moves it from there on. Derivatives always stand outside of guards:
under a guard analysis computes them into numbers of its own, and the derivative proper reads those at the
end of the pass, so that a derivative whose guard is shut keeps its last value.

**Loop.** Rule 0 moves t on by COMINT after the last sample too. inf and nan are looked for at communication
points, states first, then columns; the row is not written. The test difference of rules 4, 7, 8 is relative
to |x| + 1 at the step's start; a difference that is nan counts as small, and the states' nan ends the run.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal, NamedTuple

from desire_tui.engine.nodes import node

if TYPE_CHECKING:
    from desire_tui.engine.source import Source, Span

# --------------------------------------------------------------------------------------------- expressions


@node
class Const:
    """A number."""

    value: float


@node
class Load:
    """The scalar (or array element) in a slot. `t` is slot 0."""

    slot: int


@node
class Op:
    """An operation, elementwise over vectors.

    `name`: `add sub mul div neg`, `pow` (general power), `ipow` (second argument a whole `Const`: repeated
    products, binary powering from the top bit, negative n as 1/x^|n|), or a library function of language.md
    4.1: `sin cos tan asin acos atan sinh cosh tanh exp sqrt abs ln log atan2 lim sat SAT deadz deadc swtch
    sgn comp rect tri sinc sigmoid SIGMOID round trnc recip max min ran gauss` (`ran` and `gauss` have no
    arguments here).
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
class Shifted:
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
class RowOf:
    """Row ((trnc(iRow) - 1) mod rows) + 1 of a matrix; error 124 where iRow < 1 is the runtime's business."""

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


Value = Const | Load | Op | Table1 | Table2 | Vec | Shifted | MatVec | RowOf | Outer

# --------------------------------------------------------------------------------------------- statements


class Where(NamedTuple):
    """Place of the statement in the program, and of the invocation that expanded it (a submodel's body)."""

    span: Span
    invoked_at: Span | None = None


@node
class Set:
    """Scalar slot ← value.

    `persistent`: read before it is set in a pass, so every pass it belongs to must run it.
    """

    slot: int
    value: Value
    where: Where
    persistent: bool = False


@node
class SetVec:
    """Vector ← value.

    `mode`: `set`, `add` (x ← x + v), `largest` (keep the largest element, ties: the highest index, others 0).
    `mask_slot`: elements where the mask is not 0 become 0 (`set`), as language.md 9.2.
    """

    slot: int
    count: int
    value: Value
    where: Where
    mode: Literal["set", "add", "largest"] = "set"
    mask_slot: int | None = None
    persistent: bool = False


@node
class SetMat:
    """Matrix ← value (`set`) or ← itself + value (`add`), then bounded; where the mask is 0 it stays."""

    slot: int
    rows: int
    cols: int
    value: Value
    where: Where
    mode: Literal["set", "add"] = "set"
    lower: Value | None = None
    upper: Value | None = None
    mask_slot: int | None = None
    persistent: bool = False


@node
class DotTerm:
    """One product of a DOT: sum of u[i] * v[i]; `right` None means `u * 1`, else Vec or MatVec."""

    sign: float
    left: Vec
    right: Vec | MatVec | None


@node
class SetDot:
    """Scalar ← sum of products; divided by the length where `average`."""

    slot: int
    terms: tuple[DotTerm, ...]
    average: bool
    where: Where
    persistent: bool = False


@node
class Deriv:
    """Derivative of state number `state` (counted through `Segment.states`)."""

    state: int
    value: Value
    where: Where


@node
class DerivVec:
    """Derivatives of `count` states from number `state` on."""

    state: int
    count: int
    value: Value
    where: Where


@node
class Store:
    """`store X = x`: at communication points only; `counter` numbers its position in `RunMemory.counters`."""

    array_slot: int
    count: int
    slot: int
    counter: int
    where: Where


@node
class Get:
    """`get x = X`: at communication points, constant between."""

    slot: int
    array_slot: int
    count: int
    counter: int
    where: Where


@node
class DelayLine:
    """`tdelay` (`per_step`: at steps' starts) or `delay` (at communication points); a ring buffer.

    The output is the value written `lag` records ago: element (k - lag) mod count of the buffer, read before
    record k is written to element k mod count; for lag 0 the value itself. So the buffer's contents are
    what was before the first record, from its end backwards. `lag` is found from tau at a run's start:
    floor(tau / DT + 1e-9) or floor(tau / COMINT + 1e-9); larger than `count`: error 105.
    """

    slot: int
    buffer_slot: int
    count: int
    source: Value
    tau: Value
    per_step: bool
    counter: int
    where: Where


@node
class TrackHold:
    """`trkhld y, y0 = p, x`: if p > 0 then y ← y0, y0 ← x."""

    held_slot: int
    tracked_slot: int
    control: Value
    value: Value
    where: Where


@node
class Terminate:
    """`term e`: tested where STEP is on; `number` counts the segment's term statements from 0."""

    value: Value
    number: int
    where: Where


@node
class Learn:
    """CLEARN, PLEARN, INTP (docs/neural.md): vectors and matrices by slot."""

    kind: Literal["CLEARN", "PLEARN", "INTP"]
    out_slot: int
    out_count: int
    weights_slot: int
    in_slot: int
    in_count: int
    rate: Value
    criterion: Value | None
    count_slot: int | None
    where: Where


@node
class Guard:
    """Statements that run only: `step` where STEP, `out` where COMM, `sample` at every m-th communication
    point (`every` ≥ 1), `if` while `condition` > 0 (else `orelse`).
    """  # noqa: D205

    kind: Literal["step", "out", "sample", "if"]
    body: tuple[Action, ...]
    where: Where
    condition: Value | None = None
    orelse: tuple[Action, ...] = ()
    every: int = 1


Action = (
    Set
    | SetVec
    | SetMat
    | SetDot
    | Deriv
    | DerivVec
    | Store
    | Get
    | DelayLine
    | TrackHold
    | Terminate
    | Learn
    | Guard
)

# --------------------------------------------------------------------------------------------- the segment


@node
class StateRange:
    """Consecutive states: `count` states from number `first` on live in `slot … slot+count-1`."""

    name: str
    slot: int
    first: int
    count: int
    where: Where


@dataclass(frozen=True, slots=True)
class Column:
    """A requested variable: its name as written (`x`, `A[2]`) and its slot."""

    name: str
    slot: int
    where: Where


@dataclass(frozen=True, slots=True)
class Request:
    """dispt, dispxy, DISPXY or type, with the variables they sample."""

    kind: Literal["dispt", "dispxy", "DISPXY", "type"]
    columns: tuple[Column, ...]
    channel: int | None = None
    where: Where | None = None


@dataclass(frozen=True, slots=True)
class Picture:
    """`SHOW A, ncol`: the array's values are kept at each communication point."""

    name: str
    slot: int
    count: int
    columns: int


@dataclass(frozen=True, slots=True)
class Entry:
    """J[row, column] = value, states from 0."""

    row: int
    column: int
    value: Value
    where: Where | None = None


@dataclass(frozen=True)
class Jacobian:
    """The JACOBIAN segment: `body` computes helper variables, `entries` fill the matrix at `slot`."""

    slot: int
    body: tuple[Action, ...]
    entries: tuple[Entry, ...]


@dataclass(frozen=True)
class Segment:
    """Everything a back end needs. `requests` holds at most one display request and one `type`.

    `scalars` lists the slots of scalars that the segment sets; `counters` says how many history positions
    it has.
    """

    label: str | None
    source: Source
    body: tuple[Action, ...]
    states: tuple[StateRange, ...]
    requests: tuple[Request, ...] = ()
    pictures: tuple[Picture, ...] = ()
    stash: tuple[Column, ...] = ()
    recover: tuple[Column, ...] = ()
    jacobian: Jacobian | None = None
    counters: int = 0
    scalars: tuple[int, ...] = ()
    names: dict[int, str] = field(default_factory=dict)

    @property
    def columns(self) -> tuple[Column, ...]:
        """What a row of samples holds behind t: the requests' variables in turn, then the stashed ones."""
        return tuple(column for request in self.requests for column in request.columns) + self.stash

    @property
    def order(self) -> int:
        """Number of states."""
        return sum(r.count for r in self.states)
