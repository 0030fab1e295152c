"""A program's lines and their ends. Several views may show one; followers are called at every replacement."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.document._document import Document, EditResult

from desire_tui.editor import line_ends
from desire_tui.editor.line_ends import EndedText, with_line_feeds

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from textual.document._document import Location

    Follower = Callable[[Location, Location, Location], None]


class ProgramLines(Document):
    """Only line feeds and carriage returns end lines: a form feed in a line stays where it is."""

    def __init__(self, text: str) -> None:
        super().__init__("")
        self._lines = with_line_feeds(text).split("\n")
        self._ends = line_ends.ends_of(text)
        self.usual_end = line_ends.usual(self._ends)
        """What ends a new line."""
        self.followers: list[Follower] = []
        """Called with where the replaced text began and ended, and where the new text ends."""

    @property
    def ends(self) -> list[str]:
        """What ends each line in the file."""
        return self._ends

    @property
    def ended_text(self) -> str:
        """The text with the line ends of the file."""
        return line_ends.ended(self._lines, self._ends)

    def take_ends(self, text: str) -> None:
        """Let the lines end as those of a file with the same lines."""
        self._ends = line_ends.ends_of(text)
        self.usual_end = line_ends.usual(self._ends, self.usual_end)

    def replace_range(self, start: Location, end: Location, text: str) -> EditResult:
        """Replace what stands between two places; every change of the text comes here, undo and redo too."""
        (top, left), (bottom, right) = sorted((start, end))
        lines = self._lines
        replaced = self.get_text_range((top, left), (bottom, right))
        before = lines[top][:left] if top < len(lines) else ""
        after = lines[bottom][right:] if bottom < len(lines) else ""
        new = with_line_feeds(text).split("\n")
        if top != bottom or len(new) > 1:
            replaced = EndedText(replaced, self._ends[top : bottom + 1])  # to be put back by undo
            self._replace_ends(replaced.ends, text, new, top, before, after)
        new[0] = before + new[0]
        place = (top + len(new) - 1, len(new[-1]))
        new[-1] += after
        lines[top : bottom + 1] = new
        for follower in self.followers:
            follower((top, left), (bottom, right), place)
        return EditResult(place, replaced)

    def _replace_ends(
        self, removed: Sequence[str], text: str, new: Sequence[str], top: int, before: str, after: str
    ) -> None:
        if isinstance(text, EndedText):
            ends = text.ends
        else:
            ends = line_ends.ends_after(removed, len(new), before, after, self.usual_end)
        self._ends[top : top + len(removed)] = ends

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
