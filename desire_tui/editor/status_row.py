"""The row below the editor: what is wrong at the cursor, where the cursor is, and the OK button.

A problem that one row is too short for takes several.
"""

from __future__ import annotations

from textwrap import wrap
from typing import TYPE_CHECKING

from rich.cells import cell_len
from textual.containers import Horizontal
from textual.content import Content
from textual.message import Message
from textual.widgets import Label

if TYPE_CHECKING:
    from textual import events
    from textual.app import ComposeResult

    from desire_tui.editor.code_area import CodeArea


ROWS_ALWAYS = 4
"""A problem may have so many rows; more if the text keeps half of the height."""


class StatusRow(Horizontal):
    """One row about the text in front."""

    DEFAULT_CSS = """
    StatusRow { height: 1; background: $panel; }
    StatusRow #problem { width: 1fr; height: 100%; color: $text-muted; text-overflow: ellipsis; }
    StatusRow #problem.-error { color: $text-error; }
    StatusRow #place { width: auto; padding: 0 1; color: $text-muted; }
    StatusRow #ok { width: auto; background: $primary; color: $background; text-style: bold; }
    StatusRow #ok:hover { background: $accent; }
    """

    class Accepted(Message):
        """The OK button was pressed."""

    rows = 1
    """How many rows of the screen it takes."""
    _grown_at: tuple[CodeArea, int] | None = None

    def compose(self) -> ComposeResult:
        """Problem, place, button."""
        yield Label("", id="problem", markup=False)
        yield Label("", id="place")
        yield Label(" OK ", id="ok")

    def show(self, area: CodeArea, *, checked: bool = False) -> None:
        """Show the cursor's place in a text, and the problem there or how many there are.

        `checked`: the problems are those of the text as it stands. Else a problem that is gone from the line
        that is being typed is likely to come back: it keeps its room, or the text would move with every key.
        """
        row, column = area.cursor_location
        problems = area.marks.problems
        marks = problems.get(row, [])
        mark = next((m for m in marks if m.start <= column <= m.end), marks[0] if marks else None)
        if mark is not None:
            take = f" · Alt+U: {mark.fix.text}" if mark.fix is not None else ""
            sentence = f" {mark.text}{take}"
        elif count := sum(map(len, problems.values())):
            sentence = f" {count} problem{'s' if count > 1 else ''} · F8"
        else:
            sentence = ""
        shape = (
            area.buffer.shape if area.buffer.is_program else f"text, unchecked {area.buffer.shape}".strip()
        )
        self._set_label("#place", f"{shape}{'  ' if shape else ''}{row + 1}:{column + 1}")
        label = self._set_label("#problem", sentence)
        label.set_class(mark is not None and mark.style == "error", "-error")
        label.tooltip = Content(mark.text) if mark else None
        self._make_room(area, sentence if mark is not None else "", label.size.width, checked=checked)

    def _make_room(self, area: CodeArea, sentence: str, width: int, *, checked: bool) -> None:
        """Show a problem whole: over several rows where one is too short."""
        rows, place = 1, (area, area.cursor_location[0])
        if width and cell_len(sentence) > width:
            half = (area.size.height + self.rows) // 2
            rows = min(len(wrap(sentence, width)), max(ROWS_ALWAYS, half))
        if rows > self.rows:
            self._grown_at = place
        elif rows == self.rows or (not checked and place == self._grown_at):
            return
        self.rows = self.styles.height = rows

    def _set_label(self, place: str, text: str) -> Label:
        """Show a text in the row below; a key that changes nothing there draws nothing, lays out nothing."""
        label = self.query_one(place, Label)
        if (before := str(label.content)) != text:
            label.update(text, layout=place == "#place" and len(before) != len(text))
        return label

    def on_click(self, event: events.Click) -> None:
        """Press the OK button."""
        if event.widget is not None and event.widget.id == "ok":
            self.post_message(self.Accepted())
