"""Where Taylor coefficients stand in memory."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.jit.compiler import machine
from desire_tui.engine.integration.taylor.memory import ORDER_MOST
from desire_tui.engine.passes.series.nodes import Series

if TYPE_CHECKING:
    from collections.abc import Iterable

    from desire_tui.engine.passes.series.nodes import SeriesProgram

ROW = 24
"""Numbers kept for one number's series, orders up to ORDER_MOST, in whole cache lines."""
CELL = 16
"""Numbers in a cell: a vector of sums or coefficients, and some single ones (`scalar`)."""
VECTORS = 4
"""So many vectors are computed side by side: none waits for its own last sum."""

_SHORT = frozenset((
    "state", "raised", "add", "sub", "neg", "times", "plus_times", "over", "mul", "div", "sqrt",
    "integral", "quotient", "power", "select", "gather",
))  # fmt: skip
_WITH_ROWS = frozenset(("mul", "div", "sqrt", "integral", "quotient", "power"))
_VECTORS_MOST = 400
"""In all arrays of a model whose arrays are short: the text grows with them."""


class Layout:
    """Places in a flat array: first what must be 0 at a step's start, then rows and arrays.

    A number's coefficients are neighbours: coefficient k at `place` + k. An array's k-th coefficients are
    neighbours: element i's at `place` + k·`apart` + i; `apart` is 0 where nobody reads those of lower orders,
    so that there is one row for all.
    """

    def __init__(self, program: SeriesProgram) -> None:
        assert ORDER_MOST < ROW
        self.is_short = are_short(program)
        """Whether arrays' coefficients are in registers: rows are those that others read, side by side."""
        self.in_tiles = False
        """Whether arrays' coefficients but for the states' stand elsewhere (`tile_layout`)."""
        self.kept = {node.number for node in rows_read(program)}
        """Arrays with a row for each order."""
        derivatives = (piece.derivative for piece in program.states)
        self.begun = self.kept | {d.number for d in derivatives if isinstance(d, Series)}
        """Arrays whose coefficients 0 are read from their row."""
        self._places: dict[int, int] = {}
        self._cells: dict[tuple[str, int], int] = {}
        self._squares: dict[tuple[int, int], int] = {}
        self._program = program
        self.cleared = 0

    def cell(self, what: str, number: int) -> int:
        """Return the place of a series' cell, which is 0 at a step's start."""
        return self._cells[what, number]

    def squares(self, which: tuple[int, int]) -> int:
        """Return the place of the products of equal orders that a sum consists of: 2k's at `place` + 2k."""
        return self._squares[which]

    def finish(self, cells: Iterable[tuple[str, int]], sums: Iterable[tuple[int, int]]) -> None:
        """Give everything its place: `cells` of series in memory, rows for `sums` of products."""
        place = 0
        for cell in cells:
            self._cells[cell] = place
            place += CELL
        self.cleared = place
        for which in sums:
            self._squares[which] = place
            place += ROW
        if self.is_short:
            start = place = -(-place // 8) * 8
            for node in rows_read(self._program):
                self._places[node.number] = place
                place += -(-node.size // 8) * 8
            self._stride = place - start
            place += ORDER_MOST * self._stride
        states = {piece.series.number for piece in self._program.states}
        for node in self._program.nodes:
            if node.count is not None and (self.is_short or (self.in_tiles and node.number not in states)):
                continue
            self._places[node.number] = place
            if node.count is None:
                place += ROW
            else:
                place += row_length(node) * (ORDER_MOST + 1 if node.number in self.kept else 1)
            place = -(-place // 8) * 8
        self.zeros = place
        """Numbers that are always 0."""
        self.room = place + 4 * ROW

    def place(self, node: Series) -> int:
        """Return where coefficient 0 stands, an array's first element's."""
        return self._places[node.number]

    def has_place(self, node: Series) -> bool:
        """Whether a series' coefficients are kept."""
        return node.number in self._places

    def apart(self, node: Series) -> int:
        """Return the distance of an element's neighbouring coefficients."""
        if node.count is None:
            return 1
        if self.is_short:
            return self._stride
        return row_length(node) if node.number in self.kept else 0

    @property
    def pieces(self) -> list[tuple[int, int, int, int]]:
        """The states' places, as `integration.taylor.memory.Taylor` wants them."""
        return [(p.first, p.count, self.place(p.series), self.apart(p.series)) for p in self._program.states]

    @property
    def mode_count(self) -> int:
        """So many of the arguments are modes'."""
        return self._program.mode_count

    @property
    def conditions(self) -> tuple[int, ...]:
        """Which arguments are the events' conditions (`passes.series.nodes`)."""
        return self._program.conditions

    @property
    def arguments(self) -> list[tuple[int, int]]:
        """The places of modes' and events' arguments, as `integration.taylor.memory.Taylor` wants them."""
        return [
            (self.place(o) + at, self.apart(o)) if isinstance(o, Series) else (-1, 0)
            for o, at in self._program.arguments
        ]

    @property
    def roots(self) -> list[tuple[int, int, int]]:
        """Where square roots stand, as `integration.taylor.memory.Taylor` wants them."""
        found = [node for node in self._program.nodes if node.kind == "sqrt"]
        return [(self.place(node), self.apart(node), node.count or 1) for node in found]


def are_short(program: SeriesProgram) -> bool:
    """Whether all arrays are short enough for registers, and of kinds that `short_arrays` knows."""
    arrays = [node for node in program.nodes if node.count is not None]
    known = all(node.kind in _SHORT for node in arrays) and all(n.kind != "total" for n in program.nodes)
    most = _VECTORS_MOST * machine().width
    return bool(arrays) and known and sum(node.size for node in arrays) <= most


def rows_read(program: SeriesProgram) -> list[Series]:
    """Return the arrays whose coefficients of lower orders others read: the solver, sums of products."""
    found = [piece.series for piece in program.states]
    found += [operand for operand, _ in program.arguments if isinstance(operand, Series)]
    for node in program.nodes:
        if node.count is None or node.kind not in _WITH_ROWS:
            continue
        found += [operand for operand in node.operands if isinstance(operand, Series)]
        if node.kind != "mul":
            found.append(node)
    arrays = {node.number: node for node in found if node.count is not None}
    return list(arrays.values())


def strip(size: int) -> int:
    """Return how many elements of an array of this size are computed at a time; rows are multiples of it."""
    most = VECTORS * machine().width
    if size > most:  # 42 elements: three times 16, not twice 32
        return min(most, most // 2, key=lambda width: -(-size // width) * width)
    return next((width for width in (2, 4, 8, 16, 32) if size <= width < most), most)


def row_length(node: Series) -> int:
    """Return how many numbers an array's coefficients of an order take: whole strips."""
    return -(-node.size // strip(node.size)) * strip(node.size)
