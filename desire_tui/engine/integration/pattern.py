"""Where a Jacobian is not zero, and which of its columns may be found together."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.data_classes import dataclass

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Numbers = NDArray[np.int32]


@dataclass(frozen=True, eq=False)
class Pattern:
    """Entries (row, column) that may differ from 0, sorted by column, then row, each once.

    The whole diagonal is among them (it is needed: the matrix of an implicit step is I − γJ).
    """

    n: int
    rows: Numbers
    columns: Numbers

    @classmethod
    def of(cls, n: int, rows: Numbers, columns: Numbers) -> Pattern:
        """Sort the entries, drop repeated ones, add the diagonal."""
        states = np.arange(n, dtype=np.int64)
        codes = np.concatenate((columns.astype(np.int64) * n + rows, states * n + states))
        codes = np.unique(codes)
        return cls(n, (codes % n).astype(np.int32), (codes // n).astype(np.int32))

    @classmethod
    def full(cls, n: int) -> Pattern:
        """Every entry."""
        states = np.arange(n, dtype=np.int32)
        return cls(n, np.tile(states, n), np.repeat(states, n))

    @property
    def count(self) -> int:
        """Number of entries."""
        return len(self.rows)

    @cached_property
    def lower(self) -> int:
        """Number of diagonals below the main one."""
        return max(int((self.rows - self.columns).max(initial=0)), 0)

    @cached_property
    def upper(self) -> int:
        """Number of diagonals above the main one."""
        return max(int((self.columns - self.rows).max(initial=0)), 0)

    @cached_property
    def starts(self) -> Numbers:
        """Where each column's entries begin; n + 1 numbers."""
        return np.searchsorted(self.columns, np.arange(self.n + 1)).astype(np.int32)

    @cached_property
    def colours(self) -> Numbers:
        """A colour for each state, from 0: states of one colour share no row.

        Curtis, Powell and Reid, "On the estimation of sparse Jacobian matrices", 1974: the first colour
        that fits, state after state. For a full band this gives lower + upper + 1 colours, the least
        possible.
        """
        n = self.n
        widest_row = int(np.bincount(self.rows, minlength=1).max(initial=0))
        if widest_row > n // 2:  # at least so many colours are needed anyhow: the search would not pay
            return np.arange(n, dtype=np.int32)
        width = self.lower + self.upper + 1
        if width <= max(self.count // n, 8):  # about a full band
            return (np.arange(n, dtype=np.int32) % width).astype(np.int32)
        return self._greedy()

    def _greedy(self) -> Numbers:
        by_row = np.argsort(self.rows, kind="stable")
        row_starts = np.searchsorted(self.rows[by_row], np.arange(self.n + 1))
        neighbours = self.columns[by_row]
        colours = np.full(self.n, -1, dtype=np.int32)
        starts, rows = self.starts, self.rows
        for state in range(self.n):
            used: set[int] = set()
            for row in rows[starts[state] : starts[state + 1]]:
                used.update(colours[neighbours[row_starts[row] : row_starts[row + 1]]].tolist())
            colour = 0
            while colour in used:
                colour += 1
            colours[state] = colour
        return colours
