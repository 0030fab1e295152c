"""Statements that give a name its meaning: variables, FUNCTIONs, submodels."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from desire_tui.engine.nodes.record import Node, node

if TYPE_CHECKING:
    from desire_tui.engine.nodes.expressions import Expr


@node
class Declared(Node):
    """One name of a declaration; no dimensions for a scalar."""

    name: str
    dimensions: tuple[Expr, ...]
    start: int = 0
    end: int = 0


@node
class DeclaredGroup(Node):
    """`a[n] + b[m] = ab`: names that stand side by side, and the name of the whole (None without `=`)."""

    parts: tuple[Declared, ...]
    whole: str | None
    start: int = 0
    end: int = 0


@node
class Declare(Node):
    """ARRAY, STATE, INTEGER or COMPLEX."""

    kind: Literal["ARRAY", "STATE", "INTEGER", "COMPLEX"]
    groups: tuple[DeclaredGroup, ...]
    start: int = 0
    end: int = 0


@node
class Function(Node):
    """`FUNCTION f(a$, b$) = e`."""

    name: str
    dummies: tuple[str, ...]
    body: Expr
    start: int = 0
    end: int = 0


@node
class Submodel(Node):
    """`SUBMODEL s(a$, b$)` or `MACRO`."""

    name: str
    dummies: tuple[str, ...]
    start: int = 0
    end: int = 0
