"""Products of a matrix and a vector as statements' operands."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir.shared_loops import BLOCK, LEAST
from desire_tui.engine.codegen.vector import products

if TYPE_CHECKING:
    from desire_tui.engine.codegen.vector.operands import ArrayOperands
    from desire_tui.engine.lowered.expressions import MatVec

_ROWS_LEAST = 8
"""Elements of the result in a block: as many as are computed side by side, and a cache line."""


def write_product(statements: ArrayOperands, block: ArrayOperands, node: MatVec, result: str) -> None:
    """Write A·x or Aᵀ·x to `result`; a large one is shared by elements of the result.

    `block`: made by `statements.block` before `result` was taken from scratch memory.
    """
    text = statements.text
    if node.rows * node.cols < LEAST:
        _call(statements, node, result, "0", str(_count(node)))
        return
    _call(block, node, block.temp(_count(node)), "%first", "%end")
    text.declarations |= block.text.declarations
    size = BLOCK // (node.rows if node.transposed else node.cols)
    statements.share(block, _count(node), max(_ROWS_LEAST, size // _ROWS_LEAST * _ROWS_LEAST))


def _count(node: MatVec) -> int:
    return node.cols if node.transposed else node.rows


def _call(statements: ArrayOperands, node: MatVec, result: str, first: str, end: str) -> None:
    """Write the elements from `first` to before `end`."""
    text = statements.text
    a, x = statements.at(node.slot), statements.at(node.x_slot)
    if node.transposed:
        text.declarations.add(products.transposed_times_vector())
        sizes = f"i64 {node.rows}, i64 {node.cols}, i64 {first}, i64 {end}"
        text.do(f"call void @tmatvec(ptr {a}, ptr {x}, ptr {result}, {sizes})")
        return
    text.declarations.add(products.matrix_times_vector())
    at = text.op(f"getelementptr double, ptr {a}, i64 {text.op(f'mul i64 {first}, {node.cols}')}")
    to = text.op(f"getelementptr double, ptr {result}, i64 {first}")
    sizes = f"i64 {text.op(f'sub i64 {end}, {first}')}, i64 {node.cols}"
    text.do(f"call void @matvec(ptr {at}, ptr {x}, ptr {to}, {sizes})")
