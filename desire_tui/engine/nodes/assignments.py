"""Statements that give a number or an array a value, in the script or in a segment."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.nodes.lazy_parts import LazyParts
from desire_tui.engine.nodes.record import Node, node

if TYPE_CHECKING:
    from desire_tui.engine.nodes.expressions import Expr, Target


@node
class Assign(LazyParts):
    """`x = e`, `x[i] = e`: script assignment, defined variable, difference equation, Jacobian element."""

    target: Target
    value: Expr
    start: int = 0
    end: int = 0


@node
class Bare(Node):
    """An expression alone: a command prints it; in a segment `name(a, b)` invokes a submodel."""

    value: Expr
    start: int = 0
    end: int = 0


@node
class MatrixAssign(Node):
    """`MATRIX W = [M] sum ; lower, upper`; `DELTA` adds (`delta`)."""

    name: str
    value: Expr
    delta: bool
    mask: str | None
    lower: Expr | None
    upper: Expr | None
    start: int = 0
    end: int = 0


@node
class VectorAssign(Node):
    """`Vector y = [m] v`, `Vector y^ = v` (`largest`), `Vectr delta x = v; lower, upper` (`delta`)."""

    name: str
    value: Expr
    delta: bool
    largest: bool
    mask: str | None
    lower: Expr | None = None
    upper: Expr | None = None
    start: int = 0
    end: int = 0


@node
class Dot(Node):
    """`DOT s = u*v + …`; `AVG` divides by the length."""

    target: Target
    value: Expr
    average: bool
    start: int = 0
    end: int = 0
