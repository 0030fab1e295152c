"""Where Taylor coefficients stand in memory."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.integration.taylor.memory import ORDER_MOST
from desire_tui.engine.passes.series.nodes import Series

if TYPE_CHECKING:
    from desire_tui.engine.passes.series.nodes import SeriesProgram

ROW = 32
"""Numbers kept for one number's series: orders up to ORDER_MOST, and what vector code reads beyond."""
WIDTH = 8
"""Rows of arrays are whole multiples of so many numbers, so that loops over elements leave no rest."""


class Layout:
    """Places in a flat array: first what must be 0 at a step's start, then arrays.

    A number's coefficients are neighbours: coefficient k at `place` + k. An array's k-th coefficients are
    neighbours: element i's at `place` + k·`apart` + i.
    """

    def __init__(self, program: SeriesProgram) -> None:
        assert ORDER_MOST + WIDTH < ROW
        self._places: dict[int, int] = {}
        self._extra: dict[tuple[str, int], int] = {}
        self.cleared = 0
        for node in program.nodes:
            if node.count is None:
                self._places[node.number] = self._row()
        self._end = self.cleared
        self._arrays = [node for node in program.nodes if node.count is not None]
        self._placed = False
        self._program = program

    def row_for(self, what: str, node: Series) -> int:
        """Return the place of a row that belongs to a number's series besides its coefficients."""
        key = what, node.number
        if key not in self._extra:
            assert not self._placed
            self._extra[key] = self._row()
        return self._extra[key]

    def finish(self) -> None:
        """Place arrays behind all rows."""
        self._placed = True
        place = self.cleared
        for node in self._arrays:
            self._places[node.number] = place
            place += apart(node) * (ORDER_MOST + 1) + WIDTH
        self.room = place + WIDTH

    def _row(self) -> int:
        place = self.cleared
        self.cleared += ROW
        return place

    def place(self, node: Series) -> int:
        """Return where coefficient 0 stands, an array's first element's."""
        return self._places[node.number]

    @property
    def pieces(self) -> list[tuple[int, int, int, int]]:
        """The states' places, as `integration.taylor.memory.Taylor` wants them."""
        return [(p.first, p.count, self.place(p.series), apart(p.series)) for p in self._program.states]

    @property
    def arguments(self) -> list[tuple[int, int]]:
        """The places of the modes' arguments, as `integration.taylor.memory.Taylor` wants them."""
        return [
            (self.place(o) + at, apart(o)) if isinstance(o, Series) else (-1, 0)
            for o, at in self._program.arguments
        ]


def apart(node: Series) -> int:
    """Return the distance of an element's neighbouring coefficients."""
    return 1 if node.count is None else -(-node.count // WIDTH) * WIDTH
