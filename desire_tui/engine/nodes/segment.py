"""Statements of a DYNAMIC segment only."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from desire_tui.engine.nodes.record import Statement, node

if TYPE_CHECKING:
    from desire_tui.engine.nodes.expressions import Call, Expr, Target


@node
class Derivative(Statement):
    """`d/dt x = e`."""

    target: Target
    value: Expr
    start: int = 0
    end: int = 0


@node
class VectorDerivative(Statement):
    """`Vectr d/dt x = v`."""

    name: str
    value: Expr
    start: int = 0
    end: int = 0


@node
class Store(Statement):
    """`store X = x`."""

    array: str
    variable: Target
    start: int = 0
    end: int = 0


@node
class Get(Statement):
    """`get x = X`."""

    variable: Target
    array: str
    start: int = 0
    end: int = 0


@node
class Delay(Statement):
    """`tdelay y = D(x, tau` (`per_step`) or `delay y = D(x, tau`."""

    variable: Target
    buffer: str
    source: Expr
    tau: Expr
    per_step: bool
    start: int = 0
    end: int = 0


@node
class TrackHold(Statement):
    """`trkhld y, y0 = p, x`."""

    held: Target
    tracked: Target
    control: Expr
    value: Expr
    start: int = 0
    end: int = 0


@node
class FunctionTable(Statement):
    """The older forms `func y = F(x`, `func2 f = F(x, y; X, Y`: `call` is the func1 or func2 they mean."""

    target: Target
    call: Call
    start: int = 0
    end: int = 0


@node
class Term(Statement):
    """`term e`."""

    value: Expr
    start: int = 0
    end: int = 0


@node
class Sample(Statement):
    """`SAMPLE m`."""

    every: Expr
    start: int = 0
    end: int = 0


@node
class Learn(Statement):
    """`CLEARN v = W(x) lrate, crit[#]`, `PLEARN y = W*x; lrate`, `INTP v = W*x; thresh`."""

    kind: Literal["CLEARN", "PLEARN", "INTP"]
    output: str
    weights: str
    input: str
    rate: Expr
    criterion: Expr | None
    conscience: bool
    start: int = 0
    end: int = 0


@node
class Invoke(Statement):
    """`invoke s(a, b)`; the form without the word is a `Bare` call."""

    name: str
    args: tuple[Expr, ...]
    start: int = 0
    end: int = 0
