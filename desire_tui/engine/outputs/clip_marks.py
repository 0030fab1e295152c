"""Marks at the frame of a text graph where curves leave it, and a line that says so."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.graph.fit import HAIR

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.engine.outputs.text_frame import TextFrame

    Floats = NDArray[np.float64]
    Flags = NDArray[np.bool_]

ABOVE, BELOW, LEFT, RIGHT = "▲▼◀▶"
ROOM_FOR_TEXT = 0.8
"""A text that takes more of the upper side than this part is shortened."""


class ClipMarks:
    """Columns and rows of cells where points lie outside of a window."""

    def __init__(self, columns: int, rows: int) -> None:
        self.above, self.below = np.zeros(columns, dtype=bool), np.zeros(columns, dtype=bool)
        self.left, self.right = np.zeros(rows, dtype=bool), np.zeros(rows, dtype=bool)

    def add(self, x: Floats, y: Floats) -> None:
        """Mark points given in parts of the window; none for those beyond a corner."""
        if _leaves(y):
            _mark(x, y, self.below, self.above)
        if _leaves(x):
            _mark(1.0 - y, x, self.left, self.right)

    def copy(self) -> ClipMarks:
        """Return marks of their own at the same places."""
        other = ClipMarks(0, 0)
        other.above, other.below = self.above.copy(), self.below.copy()
        other.left, other.right = self.left.copy(), self.right.copy()
        return other

    def counts(self) -> tuple[int, ...]:
        """Return how many marks there are at each side."""
        return tuple(int(side.sum()) for side in (self.above, self.below, self.left, self.right))

    def lines(self, frame: TextFrame, text: str) -> tuple[str, ...]:
        """Return the frame's lines with marks on its sides and a text in the upper one.

        A frame without net has no sides: the text takes the place of the title there.
        """
        lines = list(frame.lines)
        if not frame.has_net:
            if text:
                lines[0] = text.center(len(lines[0]))[: len(lines[0])]
            return tuple(lines)
        first, last = frame.top - 1, frame.top + frame.rows
        for number, side, sign in ((first, self.above, ABOVE), (last, self.below, BELOW)):
            line = list(lines[number])
            for column in np.flatnonzero(side).tolist():
                line[frame.left + column] = sign
            lines[number] = "".join(line)
        for place, side, sign in ((-1, self.left, LEFT), (frame.columns, self.right, RIGHT)):
            for row in np.flatnonzero(side).tolist():
                line = list(lines[frame.top + row])
                line[frame.left + place] = sign
                lines[frame.top + row] = "".join(line)
        if text:
            if len(text) > ROOM_FOR_TEXT * frame.columns:  # it would hide the marks that it speaks of
                text = text.replace(" curves", "").replace(" curve", "")
            text = f" {text} "[: frame.columns]
            start = frame.left + (frame.columns - len(text)) // 2
            lines[first] = lines[first][:start] + text + lines[first][start + len(text) :]
        return tuple(lines)


def _leaves(values: Floats) -> bool:
    low, high = np.fmin.reduce(values, initial=0.0), np.fmax.reduce(values, initial=0.0)
    return bool(low < -HAIR or high > 1 + HAIR)


def _mark(along: Floats, across: Floats, low: Flags, high: Flags) -> None:
    with np.errstate(invalid="ignore"):
        between = (along >= 0) & (along <= 1)
        for side, out in ((low, across < -HAIR), (high, across > 1 + HAIR)):
            cells = (along[between & out] * len(side)).astype(np.intp)
            side[np.minimum(cells, len(side) - 1)] = True
