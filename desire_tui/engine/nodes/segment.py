"""Statements of a DYNAMIC segment only."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from desire_tui.engine.nodes.lazy_parts import LazyParts
from desire_tui.engine.nodes.record import Node, node

if TYPE_CHECKING:
    from desire_tui.engine.nodes.expressions import Call, Expr, Target


@node
class Derivative(LazyParts):
    """`d/dt x = e`."""

    target: Target
    value: Expr
    start: int = 0
    end: int = 0


@node
class VectorDerivative(Node):
    """`Vectr d/dt x = v`."""

    name: str
    value: Expr
    start: int = 0
    end: int = 0


@node
class Store(Node):
    """`store X = x`."""

    array: str
    variable: Target
    start: int = 0
    end: int = 0


@node
class Get(Node):
    """`get x = X`."""

    variable: Target
    array: str
    start: int = 0
    end: int = 0


@node
class Delay(Node):
    """`tdelay y = D(x, tau` (`per_step`) or `delay y = D(x, tau`."""

    variable: Target
    buffer: str
    source: Expr
    tau: Expr
    per_step: bool
    start: int = 0
    end: int = 0


@node
class TrackHold(Node):
    """`trkhld y, y0 = p, x`."""

    held: Target
    tracked: Target
    control: Expr
    value: Expr
    start: int = 0
    end: int = 0


@node
class FunctionTable(Node):
    """The older forms `func y = F(x`, `func2 f = F(x, y; X, Y`: `call` is the func1 or func2 they mean."""

    target: Target
    call: Call
    start: int = 0
    end: int = 0


@node
class Term(Node):
    """`term e`."""

    value: Expr
    start: int = 0
    end: int = 0


@node
class Sample(Node):
    """`SAMPLE m`."""

    every: Expr
    start: int = 0
    end: int = 0


@node
class Event(Node):
    """`event e`."""

    value: Expr
    start: int = 0
    end: int = 0


@node
class Every(Node):
    """`every T, t0`; `first` None: from t = 0 on."""

    period: Expr
    first: Expr | None
    start: int = 0
    end: int = 0


@node
class Fast(Node):
    """`fast`: the segment's arithmetic may be rearranged."""

    start: int = 0
    end: int = 0


@node
class Learn(Node):
    """`CLEARN y = W(x) lrate, crit[#]` (`fast`: with #), `PLEARN y = W*x; lrate`, `INTP y = W*x; thresh`."""

    kind: Literal["CLEARN", "PLEARN", "INTP"]
    output: str
    weights: str
    input: str
    rate: Expr
    criterion: Expr | None
    fast: bool
    start: int = 0
    end: int = 0


@node
class Invoke(Node):
    """`invoke s(a, b)`; the form without the word is a `Bare` call."""

    name: str
    args: tuple[Expr, ...]
    start: int = 0
    end: int = 0


SegmentOnly = (
    Derivative | VectorDerivative | Store | Get | Delay | TrackHold | FunctionTable | Term | Sample | Event
    | Every | Fast | Learn | Invoke
)  # fmt: skip
"""The statements of this module: a new class goes in here, too."""
