"""Signs before operands, and literals with signs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.nodes.expressions import Number, Unary

if TYPE_CHECKING:
    from desire_tui.engine.nodes.expressions import Expr

_WHOLE_POWER_LIMIT = 1 << 31


def unsigned(node: Expr) -> tuple[float, Expr]:
    """Return the sign before an operand (1 or −1), and the operand."""
    sign = 1.0
    while isinstance(node, Unary):
        sign = -sign if node.op == "-" else sign
        node = node.operand
    return sign, node


def literal(node: Expr) -> float | None:
    """Return the value of a number literal with or without a sign, None for anything else."""
    sign, operand = unsigned(node)
    return sign * operand.value if isinstance(operand, Number) else None


def whole_literal(node: Expr) -> int | None:
    """Return the value of a whole number literal with or without a sign, None for anything else."""
    value = literal(node)
    return int(value) if value is not None and value.is_integer() else None


def whole_power(node: Expr) -> int | None:
    """Return the exponent of a power that is a product: a whole number literal that 31 bits hold."""
    exponent = whole_literal(node)
    return exponent if exponent is not None and abs(exponent) < _WHOLE_POWER_LIMIT else None
