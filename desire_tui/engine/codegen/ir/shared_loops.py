"""Loops that the threads of a pool share (`codegen.threads`), a block of elements at a time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.digest import blake2b

if TYPE_CHECKING:
    from desire_tui.engine.codegen.ir.text import IrText

LEAST = 1 << 16
"""Elements from which a loop is shared: it takes some ten times as long as two threads need to meet."""
BLOCK = 1 << 12
"""Elements of a block. Sums of products are formed block by block: this is a part of their definition."""
PRODUCTS = 4
"""Elements of a matrix that a product takes in the time of one in another loop."""
PREFIX = "shared."
"""Of the functions' names."""


def write_shared(
    text: IrText, share: int, body: IrText, derivatives: str, count: str, block: int, *, values: str = "%v"
) -> None:
    """Write a loop over `count` elements, cut into blocks, for all threads.

    `share`: address of `pool.share`. `body` is the text for a block: elements %first … %end - 1, with
    `values`, `derivatives` and the context at %v, %dx and %c; no block may read what another one writes.
    """
    content = body.body()
    name = PREFIX + blake2b(content.encode(), digest_size=10).hexdigest()
    arguments = "ptr noalias %v, ptr noalias %dx, ptr noalias %c, i64 %first, i64 %end"
    text.declarations |= body.declarations
    text.declarations.add(f"define internal void @{name}({arguments}) #0 {{\n{content}\nret void\n}}")
    text.do(
        f"call void inttoptr (i64 {share} to ptr)(ptr @{name}, ptr {values}, ptr {derivatives}, ptr %c, "
        f"i64 {count}, i64 {block})"
    )


def is_large(elements: int) -> bool:
    """Whether a loop over so many elements is shared."""
    return elements >= LEAST


def blocks(count: int, block: int = BLOCK) -> int:
    """Return the number of blocks."""
    return -(-count // block)
