"""A program's lines. Several views may show one; followers are called at every replacement."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.document._document import Document, EditResult

if TYPE_CHECKING:
    from collections.abc import Callable

    from textual.document._document import Location

    Follower = Callable[[Location, Location, Location], None]


def with_line_feeds(text: str) -> str:
    """Return a text whose lines end in line feeds, whatever they ended in."""
    return text.replace("\r\n", "\n").replace("\r", "\n") if "\r" in text else text


class ProgramLines(Document):
    """Only line feeds end lines: a form feed or another control character in a line stays where it is."""

    def __init__(self, text: str) -> None:
        super().__init__("")
        self._lines = with_line_feeds(text).split("\n")
        self.followers: list[Follower] = []
        """Called with where the replaced text began and ended, and where the new text ends."""

    def replace_range(self, start: Location, end: Location, text: str) -> EditResult:
        """Replace what stands between two places; every change of the text comes here, undo and redo too."""
        (top, left), (bottom, right) = sorted((start, end))
        lines = self._lines
        replaced = self.get_text_range((top, left), (bottom, right))
        before = lines[top][:left] if top < len(lines) else ""
        after = lines[bottom][right:] if bottom < len(lines) else ""
        new = with_line_feeds(text).split("\n")
        new[0] = before + new[0]
        place = (top + len(new) - 1, len(new[-1]))
        new[-1] += after
        lines[top : bottom + 1] = new
        for follower in self.followers:
            follower((top, left), (bottom, right), place)
        return EditResult(place, replaced)

    def followed(self, at: Location, top: Location, bottom: Location, end: Location) -> Location:
        """Return where a place is now that what stood from `top` to `bottom` was replaced up to `end`."""
        if at <= top:
            return at
        if at < bottom:
            row, column = min(at, end)
            return row, min(column, len(self._lines[row]))  # its line may have become shorter
        if at[0] > bottom[0]:
            return at[0] + end[0] - bottom[0], at[1]
        return end[0], end[1] + at[1] - bottom[1]
