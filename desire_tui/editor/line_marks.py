"""What stands beside the text: problems, breakpoints, the line being traced. Rows count from 0."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import dataclass, field, replace
from desire_tui.language.problem_marks import mark_of

if TYPE_CHECKING:
    from collections.abc import Iterable

    from textual.document._document import Location

    from desire_tui.engine.diagnostics import Diagnostic
    from desire_tui.language.problem_marks import Mark

CHANGES_KEPT = 500
"""For so many changes it is known which breakpoints they took away."""


@dataclass(frozen=True, slots=True)
class Move:
    """A replacement in a text, and what becomes of its rows."""

    top: Location
    bottom: Location
    end: Location

    @property
    def rows(self) -> tuple[int, int]:
        """First and last row of what is replaced."""
        return self.top[0], self.bottom[0]

    @property
    def is_idle(self) -> bool:
        """Whether every row stays where it was."""
        return self.top[0] == self.bottom[0] == self.end[0]

    @property
    def below(self) -> int:
        """By how many rows the text behind the replacement moves."""
        return self.end[0] - self.bottom[0]

    def new(self, row: int) -> int | None:
        """Return where a row is afterwards; None if it was deleted."""
        (first, left), (last, right) = self.top, self.bottom
        if row < first:
            return row
        if row > last or (row == last and right == 0 and (last > first or left == 0)):
            return row + self.below
        if row == last:
            return row if last == first else min(row, self.end[0])
        if row == first and left > 0:
            return row
        rewritten = self.end[0] if right == 0 else self.end[0] + 1  # line by line
        return row if row < rewritten else None

    def old(self, row: int) -> int | None:
        """Return where a row was before; None if it is new."""
        return next((at for at in (row, row - self.below) if at >= 0 and self.new(at) == row), None)


@dataclass(frozen=True, slots=True)
class BreakpointChange:
    """The breakpoints of the rows that a replacement concerned, before and after it."""

    inverse: Move
    """The replacement that takes it back."""
    before: frozenset[int]
    after: frozenset[int]


@dataclass
class Marks:
    """All marks of one editor."""

    is_program: bool = True
    """Whether the text is a program: no other one is coloured."""
    problems: dict[int, list[Mark]] = field(default_factory=dict)
    breakpoints: set[int] = field(default_factory=set)
    traced: int | None = None
    found: dict[int, list[tuple[int, int]]] = field(default_factory=dict)
    """What a search found: columns for each row."""
    _moves: list[Move] = field(default_factory=list)
    takes_back: bool = False
    """Whether changes are being undone, or done again."""
    _changes: deque[BreakpointChange] = field(default_factory=lambda: deque(maxlen=CHANGES_KEPT))

    def set_problems(self, diagnostics: Iterable[Diagnostic]) -> None:
        """Replace the problems."""
        self.problems = {}
        for diagnostic in diagnostics:
            mark = mark_of(diagnostic)
            if mark is not None:
                self.problems.setdefault(mark.row, []).append(mark)

    def all_problems(self) -> list[Mark]:
        """Return every problem in the order of the rows."""
        return [mark for row in sorted(self.problems) for mark in self.problems[row]]

    # ------------------------------------------------------------------------------- following the text

    def replaced(self, top: Location, bottom: Location, end: Location) -> None:
        """Follow a replacement of what stood from `top` to `bottom`, up to `end`: marks stay with lines."""
        move = Move(top, bottom, end)
        self.found = {
            row: places
            for at, places in self.found.items()
            if not top[0] <= at <= bottom[0] and (row := move.new(at)) is not None
        }
        if move.is_idle:
            return
        self._move_breakpoints(move)
        self.problems = {
            row: marks for at, marks in self.problems.items() if (row := move.new(at)) is not None
        }
        if self.traced is not None:
            self.traced = move.new(self.traced)
        self._moves.append(move)

    def _move_breakpoints(self, move: Move) -> None:
        """Let breakpoints follow; where a change is taken back, those come back that it took away."""
        before = self._breakpoints_in(move.top[0], move.bottom[0])
        moved = {row for at in self.breakpoints if (row := move.new(at)) is not None}
        if self.takes_back:
            fitting = (c for c in reversed(self._changes) if c.inverse == move and c.after == before)
            if (undone := next(fitting, None)) is not None:
                self._changes.remove(undone)
                moved -= set(range(move.top[0], move.end[0] + 1))
                moved |= undone.before
        self.breakpoints = moved
        after = self._breakpoints_in(move.top[0], move.end[0])
        if before or after:
            self._changes.append(BreakpointChange(Move(move.top, move.end, move.bottom), before, after))

    def _breakpoints_in(self, first: int, last: int) -> frozenset[int]:
        return frozenset(row for row in self.breakpoints if first <= row <= last)

    def rotated(self, first: int, last: int, step: int) -> None:
        """Follow rows that moved up (-1) or down (1) by one; the row they passed went to the other end."""
        rows = last - first + 1
        self.breakpoints = {
            first + (at - first + step) % rows if first <= at <= last else at for at in self.breakpoints
        }
        if self._changes and self._changes[-1].inverse.rows == (first, last):  # by it the rows were moved
            self._changes[-1] = replace(self._changes[-1], after=self._breakpoints_in(first, last))

    def accepted(self) -> None:
        """From now on rows are told with respect to the text as it is."""
        self._moves.clear()

    def row_now(self, row: int) -> int | None:
        """Return where a row of the accepted text is now; None if it is gone."""
        for move in self._moves:
            at = move.new(row)
            if at is None:
                return None
            row = at
        return row

    def row_then(self, row: int) -> int | None:
        """Return which row of the accepted text stands in a row now; None if it is a new one."""
        for move in reversed(self._moves):
            at = move.old(row)
            if at is None:
                return None
            row = at
        return row

    def next_problem(self, row: int, step: int) -> Mark | None:
        """Return the first problem below `row` (step 1) or above it (step -1), going round at the end."""
        rows = sorted(self.problems)
        if not rows:
            return None
        beyond = [at for at in rows if (at - row) * step > 0]
        if step > 0:
            return self.problems[beyond[0] if beyond else rows[0]][0]
        return self.problems[beyond[-1] if beyond else rows[-1]][0]
