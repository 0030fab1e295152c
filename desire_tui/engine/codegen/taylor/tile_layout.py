"""Where coefficients of a tile stand: a part of long arrays whose orders are all computed in the cache.

A tile is some elements and a margin on both sides: in each order shifts reach a little further, and what
lacks neighbours spoils that many elements more, none of them the tile's own after as many orders as the
margin has room for (overlapped tiling: Krishnamoorthy et al., PLDI 2007).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir.shared_loops import is_large
from desire_tui.engine.codegen.jit.compiler import machine
from desire_tui.engine.codegen.taylor.layout import VECTORS, Layout
from desire_tui.engine.integration.taylor.memory import ORDER_MOST
from desire_tui.engine.passes.series.nodes import Series

if TYPE_CHECKING:
    from collections.abc import Iterable

    from desire_tui.engine.passes.series.nodes import SeriesProgram

_KINDS = frozenset((
    "state", "raised", "add", "sub", "neg", "times", "plus_times", "over", "mul", "div",
    "integral", "quotient", "power", "select", "shift",
))  # fmt: skip
"""Kinds of arrays whose elements need their neighbours' coefficients at most."""
_REACH_MOST = 16
"""So far an order's shifts may reach: with 20 orders margins are then as long as a tile."""
_ROOM = 48_000
"""Numbers that a tile's coefficients should take: a part of a core's second cache."""
_LEAST, _MOST = 256, 4096
"""Elements of a tile."""
_BEFORE = 64
"""Numbers before the first row: shifts read them, and nobody what comes of it."""


def elements_in_tiles(program: SeriesProgram) -> int:
    """Return the length of a program's arrays if they are computed tile by tile, else 0."""
    arrays = [node for node in program.nodes if node.count is not None]
    sizes = {node.size for node in arrays}
    if len(sizes) != 1 or not is_large(min(sizes)):
        return 0
    simple = all(node.kind in _KINDS and not node.slots for node in arrays)
    apart = all(node.count is not None or not _of_arrays(node) for node in program.nodes)
    apart = apart and all(p.series.count is not None or not _is_array(p.derivative) for p in program.states)
    if not simple or not apart or program.arguments or reach(program) > _REACH_MOST:
        return 0
    return min(sizes)


def reach(program: SeriesProgram) -> int:
    """Return how many elements away neighbours are that a state's next coefficient is made of."""
    found: dict[int, int] = {node.number: 0 for node in program.nodes}
    for _ in range(2):  # an integral's factor may come later
        for node in program.nodes:
            below = [found[o.number] for o in node.operands if isinstance(o, Series)]
            found[node.number] = max(below, default=0) + (abs(node.by) if node.kind == "shift" else 0)
    return max(
        (found[p.derivative.number] for p in program.states if isinstance(p.derivative, Series)), default=0
    )


def _of_arrays(node: Series) -> bool:
    return any(_is_array(operand) for operand in node.operands)


def _is_array(operand: object) -> bool:
    return isinstance(operand, Series) and operand.count is not None


class TileLayout(Layout):
    """Places in a tile's memory: rows of all orders for what others read, one row for everything else."""

    def __init__(self, program: SeriesProgram) -> None:
        super().__init__(program)
        width = VECTORS * machine().width
        arrays = [node for node in program.nodes if node.count is not None]
        rows = sum(ORDER_MOST + 1 if node.number in self.kept else 1 for node in arrays)
        self.reach = reach(program)
        margins = 2 * ORDER_MOST * self.reach
        elements = min(max(_ROOM // rows - margins, _LEAST), _MOST)
        self.elements = elements // width * width
        """Of a tile, without its margins."""
        self.stride = -(-(self.elements + margins) // width) * width + width
        place = _BEFORE
        for node in arrays:
            self._places[node.number] = place
            place += self.stride * (ORDER_MOST + 1 if node.number in self.kept else 1)
        self.room = place + _BEFORE

    def apart(self, node: Series) -> int:
        """Return the distance of rows; 0: there is one for all orders."""
        return self.stride if node.number in self.kept else 0

    def finish(self, cells: Iterable[tuple[str, int]], sums: Iterable[tuple[int, int]]) -> None:
        """Do nothing: there are no numbers' sums here."""
