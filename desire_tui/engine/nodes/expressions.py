"""What the user wrote as an expression or a condition."""

from __future__ import annotations

from typing import Literal, final

from desire_tui.engine.nodes.record import Node, node


@final
@node
class Number(Node):
    """A numeric literal (decimal, `&` octal, `&&` hexadecimal)."""

    value: float
    start: int = 0
    end: int = 0


@final
@node
class Text(Node):
    """A quoted string, without its quotes."""

    value: str
    start: int = 0
    end: int = 0


@final
@node
class Name(Node):
    """A name read or assigned: scalar or whole array."""

    name: str
    start: int = 0
    end: int = 0


@final
@node
class Element(Node):
    """A subscripted name, `A[i, k]`."""

    name: str
    subscripts: tuple[Expr, ...]
    start: int = 0
    end: int = 0


@final
@node
class Call(Node):
    """`f(a, b)`: library function, FUNCTION, or (as a statement in a segment) a submodel invocation.

    `$In` and `$Tr` of MATRIX statements are calls of those names.
    """

    name: str
    args: tuple[Expr, ...]
    start: int = 0
    end: int = 0


@final
@node
class Unary(Node):
    """A sign."""

    op: Literal["-", "+"]
    operand: Expr
    start: int = 0
    end: int = 0


@final
@node
class Binary(Node):
    """Two operands; `&` only in MATRIX and DELTA terms (`u & v`)."""

    op: Literal["+", "-", "*", "/", "^", "&"]
    left: Expr
    right: Expr
    start: int = 0
    end: int = 0


@final
@node
class Transposed(Node):
    """`A%`."""

    name: str
    start: int = 0
    end: int = 0


@final
@node
class Shifted(Node):
    """`x{k}`: element i is x[i+k], 0 outside."""

    name: str
    by: Expr
    start: int = 0
    end: int = 0


@final
@node
class RowOf(Node):
    """`P#`: the row of P that iRow selects."""

    name: str
    start: int = 0
    end: int = 0


@final
@node
class Pair(Node):
    """`[a, b]`, a complex number."""

    re: Expr
    im: Expr
    start: int = 0
    end: int = 0


@final
@node
class Truth(Node):
    """`(a <= b)` where a value is expected: 1 if the condition holds, else 0."""

    condition: Condition
    start: int = 0
    end: int = 0


Expr = Number | Text | Name | Element | Call | Unary | Binary | Transposed | Shifted | RowOf | Pair | Truth
Target = Name | Element


@final
@node
class Relation(Node):
    """`a <= b`."""

    op: Literal["=", "<", ">", "<=", ">=", "<>"]
    left: Expr
    right: Expr
    start: int = 0
    end: int = 0


@final
@node
class Logical(Node):
    """`C and D`, `C or D`."""

    op: Literal["and", "or"]
    left: Condition
    right: Condition
    start: int = 0
    end: int = 0


@final
@node
class Not(Node):
    """`not C`."""

    operand: Condition
    start: int = 0
    end: int = 0


Condition = Relation | Logical | Not
