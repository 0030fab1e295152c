"""Rows that `_` joins into one line: their text without the joints, and where its characters really stand.

The original takes the two rows as if nothing stood between them, inside a name, a number or a string too.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from desire_tui.engine.syntax.statement_tokens import LogicalLine

_JOINT = re.compile(r"_[ \t\r]*\n")
_PARTS = re.compile(
    r"""(?:--|—)[^\n]*                           # a comment is not continued
    | '(?:_[ \t\r]*\n|[^'\n])*'?|"(?:_[ \t\r]*\n|[^"\n])*"?     # a string is
    | _[ \t\r]*\n""",
    re.VERBOSE,
)


class Joints:
    """Where rows of a text are joined."""

    __slots__ = ("_places", "_shifts", "text")

    def __init__(self, text: str, found: list[tuple[int, int]]) -> None:
        self._places: list[int] = []
        """For each joint, the offset in the joined text behind it."""
        self._shifts = [0]
        """How far characters were moved by the joints up to there."""
        pieces = []
        length = end = 0
        for start, after in found:
            pieces.append(text[end:start])
            length += start - end
            end = after
            self._places.append(length)
            self._shifts.append(after - length)
        pieces.append(text[end:])
        self.text = "".join(pieces)

    def start(self, at: int) -> int:
        """Return where a character of the joined text stands."""
        return at + self._shifts[bisect_right(self._places, at)]

    def end(self, at: int) -> int:
        """Return the offset behind the character that ends before `at`: in its row, not in the next one."""
        return self.start(at - 1) + 1 if at > 0 else at

    def replace_offsets(self, line: LogicalLine) -> LogicalLine:
        """Turn all offsets of a line of the joined text into those of the real one."""
        for chunk in line.chunks:
            joined_base, chunk.base = chunk.base, self.start(chunk.base)
            chunk.starts = [self.start(joined_base + at) - chunk.base for at in chunk.starts]
            chunk.ends = [self.end(joined_base + at) - chunk.base for at in chunk.ends]
            if chunk.fault is not None:
                chunk.fault.start = self.start(joined_base + chunk.fault.start) - chunk.base
                chunk.fault.end = self.end(joined_base + chunk.fault.end) - chunk.base
        line.comments = [(self.start(start), self.end(end)) for start, end in line.comments]
        return line


def joints(text: str) -> Joints | None:
    """Return the joints of a text of several rows; None if it has none."""
    found: list[tuple[int, int]] = []
    for part in _PARTS.finditer(text):
        if part[0][0] == "_":
            found.append(part.span())
        elif part[0][0] in "'\"":
            found += [joint.span() for joint in _JOINT.finditer(text, *part.span())]
    return Joints(text, found) if found else None
