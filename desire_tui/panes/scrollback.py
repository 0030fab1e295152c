"""Lines of output, and how they break into rows of a pane's width. No widget."""

from __future__ import annotations

from itertools import islice
from typing import Literal, NamedTuple

from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.visible_text import visible

Kind = Literal["output", "command", "error", "warning", "notice", "code"]
LINES_MAX = 20_000
LINE_CHARS_MAX = 4_000
WIDTH_LEAST = 10


@dataclass(frozen=True, slots=True)
class Place:
    """A place in a program that a line of output points at; row and column from 1."""

    name: str
    row: int
    column: int


@dataclass(slots=True)
class OutputLine:
    """A line of output."""

    text: str
    kind: Kind
    place: Place | None = None


class OutputRow(NamedTuple):
    """A row of the pane: the line it is a part of, its first character, and the one behind its last."""

    line: int
    start: int
    end: int


class Scrollback:
    """The last `LINES_MAX` lines, broken into rows."""

    def __init__(self) -> None:
        self.lines: list[OutputLine] = []
        self.rows: list[OutputRow] = []
        self.width = 0
        self._open = False

    def write(self, text: str, kind: Kind) -> None:
        """Append text exactly as it comes; a line may come in pieces."""
        pieces = text.split("\n")
        if self._open and self.lines and self.lines[-1].kind == kind:
            line = self.lines[-1]
            line.text = (line.text + _shown(pieces.pop(0)))[:LINE_CHARS_MAX]
            self._lay_out(len(self.lines) - 1)
        if pieces and pieces[-1] == "":
            pieces.pop()
        first = len(self.lines)
        self.lines += [OutputLine(_shown(piece)[:LINE_CHARS_MAX], kind) for piece in pieces]
        self._open = not text.endswith("\n")
        self._lay_out(first)

    def add(self, text: str, kind: Kind, place: Place | None) -> None:
        """Append whole lines; an unfinished one before is finished."""
        first = len(self.lines)
        self.lines += [OutputLine(_shown(line)[:LINE_CHARS_MAX], kind, place) for line in text.split("\n")]
        self._open = False
        self._lay_out(first)

    def clear(self) -> None:
        """Forget everything."""
        self.lines.clear()
        self._open = False
        self._lay_out(0)

    def set_width(self, width: int) -> bool:
        """Break the lines anew for a pane of `width` cells; False if it had that width."""
        if width == self.width:
            return False
        self.width = width
        self._lay_out(0)
        return True

    def find(self, wanted: str, start: int, step: int) -> int | None:
        """Return the next line after `start` that holds a text, around the end; None if there is none."""
        count = len(self.lines)
        for distance in range(1, count + 1):
            at = (start + step * distance) % count
            if wanted.casefold() in self.lines[at].text.casefold():
                return at
        return None

    def row_of(self, line: int) -> int:
        """Return the first row of a line."""
        return next(number for number, row in enumerate(self.rows) if row.line == line)

    def _lay_out(self, first: int) -> None:
        """Break lines from number `first` on into rows."""
        if len(self.lines) > LINES_MAX:
            del self.lines[: len(self.lines) - LINES_MAX]
            first = 0
        while self.rows and self.rows[-1].line >= first:
            self.rows.pop()
        if first == 0:
            self.rows.clear()
        width = max(self.width, WIDTH_LEAST)
        for number, line in enumerate(islice(self.lines, first, None), first):
            start, end = 0, len(line.text)
            while end - start > width:
                cut = line.text.rfind(" ", start + width // 2, start + width + 1) + 1 or start + width
                self.rows.append(OutputRow(number, start, cut))
                start = cut
            self.rows.append(OutputRow(number, start, end))


def _shown(text: str) -> str:
    return visible(text).expandtabs(8)
