"""Where threads cut the states of a large model."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.codegen.ir.shared_loops import BLOCK, is_large

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

FIELDS = 4
"""Of a block: its first state's number, the number behind its last one, the first one's slot, its place among
the blocks in the order of the states."""
_BLOCKS_MOST = 60_000
"""More are of scattered single states, and slower than a loop over their slots."""


def state_blocks(ranges: Iterable[tuple[int, int, int]]) -> NDArray[np.int64] | None:
    """Return the blocks (blocks, FIELDS) of states in ranges (slot, first, count); None: they are not shared.

    All states of a block stand side by side. The first half of all blocks holds the first halves of all
    vectors and so on: a thread meets the same elements here as in the statements' loops. Those are shared if
    there are many elements in vectors of one length, and so are these.
    """
    joined: list[list[int]] = []
    lengths: dict[int, int] = {}
    for slot, first, count in ranges:
        lengths[count] = lengths.get(count, 0) + count
        if joined and count == 1 and slot == joined[-1][0] + joined[-1][2]:
            joined[-1][2] += 1
        else:
            joined.append([slot, first, count])
    if not is_large(max(lengths.values(), default=0)):
        return None
    blocks = [
        (at / count, first + at, first + min(at + BLOCK, count), slot + at)
        for slot, first, count in joined
        for at in range(0, count, BLOCK)
    ]
    if len(blocks) > _BLOCKS_MOST:
        return None
    order = sorted(range(len(blocks)), key=lambda number: blocks[number][0])
    return np.array([(*blocks[number][1:], number) for number in order], dtype=np.int64)
