"""Statements of a lowered segment."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, NamedTuple

from desire_tui.engine.nodes.record import node

if TYPE_CHECKING:
    from desire_tui.engine.lowered.expressions import MatVec, Value, Vec
    from desire_tui.engine.source import Span


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
class StoreHistory:
    """`store X = x`: at communication points only; `counter` numbers its position in `RunMemory.counters`."""

    array_slot: int
    count: int
    slot: int
    counter: int
    where: Where


@node
class GetHistory:
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
class UpdateTrackHold:
    """`trkhld y, y0 = p, x`: if p > 0 then y ← y0, y0 ← x."""

    held_slot: int
    tracked_slot: int
    control: Value
    value: Value
    where: Where


@node
class Terminate:
    """`term e`: tested where STEP is on; `number` counts the segment's term statements from 0.

    `level`: the slot of what `value` must exceed; afterwards it holds `value` if that is above 0, else 0. A
    run begins with 0 there. One that continues another is not ended at the joint. It begins with infinity
    where `value` was above 0 at the end of the run before: then it ends the run only when it grows, or after
    it has been 0 or less. Else it begins with nan, behind which comes 0. No slot: `value` must exceed 0.
    `fault`: the compiler's own test, which ends the run with this message.
    """

    value: Value
    number: int
    where: Where
    level: int | None = None
    fault: str | None = None


@node
class LearningStep:
    """CLEARN, PLEARN, INTP (docs/neural.md): vectors and matrices by slot.

    `h_slot`: CLEARN's vector of weights or of committed rows; `fast`: the winner becomes the input.
    `full_slot` ← 1 where CLEARN finds no template for its input (error 232), 2 where it has no vector h and
    needs one (error 475), else 0.
    """

    kind: Literal["CLEARN", "PLEARN", "INTP"]
    out_slot: int
    out_count: int
    weights_slot: int
    in_slot: int
    in_count: int
    rate: Value
    criterion: Value | None
    h_slot: int | None
    fast: bool
    where: Where
    full_slot: int | None = None


@node
class Guard:
    """Statements that run only at some passes.

    `step` where STEP, `out` where COMM, `sample` at every m-th communication point (`every` ≥ 1), `if` while
    `condition` > 0 (else `orelse`).
    """

    kind: Literal["step", "out", "sample", "if"]
    body: tuple[Action, ...]
    where: Where
    condition: Value | None = None
    orelse: tuple[Action, ...] = ()
    every: int = 1


Assignment = Set | SetVec | SetMat | SetDot
"""Statements that give a variable a value computed from others."""

ArrayAction = SetVec | SetMat | SetDot | DerivVec | LearningStep
"""Statements that loop over the elements of arrays."""

EffectAction = StoreHistory | GetHistory | DelayLine | UpdateTrackHold | Terminate | LearningStep
"""Statements that do more than compute a value from others: they remember, learn, end the run."""

SimpleAction = Assignment | Deriv | DerivVec | EffectAction
"""Statements that hold no others."""

Action = SimpleAction | Guard
