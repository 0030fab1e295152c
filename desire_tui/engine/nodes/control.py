"""Statements that decide where the script goes on."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.nodes.record import Node, node

if TYPE_CHECKING:
    from desire_tui.engine.nodes.expressions import Condition, Expr, Target


@node
class If(Node):
    """`if C then` (script, `condition` set) or `if e` (segment, `value` set)."""

    condition: Condition | None
    value: Expr | None
    start: int = 0
    end: int = 0


@node
class For(Node):
    """`for v = a to b [step s]`."""

    variable: Target
    first: Expr
    last: Expr
    by: Expr | None
    start: int = 0
    end: int = 0


@node
class While(Node):
    """`while C`."""

    condition: Condition
    start: int = 0
    end: int = 0


@node
class Until(Node):
    """`until C`."""

    condition: Condition
    start: int = 0
    end: int = 0


@node
class Label(Node):
    """`label L`: jump target in the script; starts a labelled segment after DYNAMIC."""

    name: str
    start: int = 0
    end: int = 0


@node
class GoTo(Node):
    """`go to L`; a line number keeps its digits."""

    target: str
    start: int = 0
    end: int = 0


@node
class Procedure(Node):
    """`PROCEDURE p(a, b; R1, R2)`."""

    name: str
    values: tuple[str, ...]
    references: tuple[str, ...]
    start: int = 0
    end: int = 0


@node
class CallProcedure(Node):
    """`call p(e1, e2; r1, r2)`."""

    name: str
    values: tuple[Expr, ...]
    references: tuple[Expr, ...]
    start: int = 0
    end: int = 0
