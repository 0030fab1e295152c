"""Find and replace: one row below the text."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, ClassVar

from textual.binding import Binding, BindingType
from textual.containers import Horizontal
from textual.message import Message
from textual.widgets import Input, Label

if TYPE_CHECKING:
    from textual.app import ComposeResult
    from textual.widgets.text_area import Location

    from desire_tui.editor.area import CodeArea


class FindBar(Horizontal):
    """Searches a text as it is typed. Capital letters in the search make it case-sensitive."""

    DEFAULT_CSS = """
    FindBar { height: 1; display: none; background: $panel; }
    FindBar Input { border: none; height: 1; width: 1fr; padding: 0 1; background: $surface; }
    FindBar Input:focus { border: none; background: $boost; }
    FindBar Label { width: auto; padding: 0 1; color: $text-muted; }
    FindBar #replacement { display: none; }
    FindBar.-replace #replacement { display: block; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape", "close", "Close", show=False),
        Binding("down", "step(1)", "Next", show=False),
        Binding("up", "step(-1)", "Previous", show=False),
        Binding("alt+a", "replace_all", "Replace all", show=False),
    ]

    class Closed(Message):
        """The user is done searching."""

    def __init__(self) -> None:
        super().__init__()
        self.area: CodeArea | None = None

    def compose(self) -> ComposeResult:
        """Two fields and a count."""
        yield Input(placeholder="find", id="wanted", select_on_focus=True)
        yield Input(placeholder="replace by · Enter one · Alt+A all", id="replacement", select_on_focus=True)
        yield Label("", id="found", markup=False)

    def open(self, area: CodeArea, wanted: str = "", *, replace: bool = False) -> None:
        """Show the bar for a text."""
        self.area = area
        self.display = True
        self.set_class(replace, "-replace")
        field = self.query_one("#wanted", Input)
        if wanted:
            field.value = wanted
        self.screen.set_focus(field)  # at once: the letters typed next are for it
        self._count()

    def places(self) -> list[tuple[Location, Location]]:
        """Return start and end of each occurrence in the text, in order."""
        wanted = self.query_one("#wanted", Input).value
        if self.area is None or not wanted:
            return []
        pattern = re.compile(re.escape(wanted), 0 if wanted != wanted.lower() else re.IGNORECASE)
        return [
            ((row, hit.start()), (row, hit.end()))
            for row, line in enumerate(self.area.document.lines)
            for hit in pattern.finditer(line)
        ]

    def action_step(self, step: int) -> None:
        """Select the next (1) or the previous (-1) occurrence, going round at the end."""
        found = self.places()
        if self.area is None or not found:
            self._count()
            return
        start, end = sorted(self.area.selection)
        if step > 0:
            number = next((n for n, (at, _) in enumerate(found) if at >= end and (at, _) != (start, end)), 0)
        else:
            number = next((n for n in reversed(range(len(found))) if found[n][0] < start), len(found) - 1)
        self._select(found, number)

    def _select(self, found: list[tuple[Location, Location]], number: int) -> None:
        assert self.area is not None
        start, end = found[number]
        self.area.move_cursor(start, center=True)
        self.area.move_cursor(end, select=True)
        self.query_one("#found", Label).update(f"{number + 1} of {len(found)}")

    def _count(self) -> None:
        found = len(self.places())
        self.query_one("#found", Label).update(f"{found} found" if found else "not found")

    def on_input_changed(self, event: Input.Changed) -> None:
        """Go to the first occurrence from the cursor on."""
        event.stop()
        if event.input.id != "wanted" or self.area is None:
            return
        found = self.places()
        if not found:
            self._count()
            return
        here = min(self.area.selection)
        self._select(found, next((n for n, (start, _) in enumerate(found) if start >= here), 0))

    def on_input_submitted(self, event: Input.Submitted) -> None:
        """Enter: next occurrence; in the second field, replace this one first."""
        event.stop()
        if event.input.id == "replacement" and self.area is not None:
            selected = tuple(sorted(self.area.selection))
            if selected in self.places():
                self.area.replace(event.value, *selected)
        self.action_step(1)

    def action_replace_all(self) -> None:
        """Replace every occurrence, as one undoable change."""
        found = self.places()
        if self.area is None or not found:
            return
        by = self.query_one("#replacement", Input).value
        lines = list(self.area.document.lines)
        for (row, start), (_, end) in reversed(found):
            lines[row] = lines[row][:start] + by + lines[row][end:]
        top, bottom = found[0][0][0], found[-1][0][0]
        self.area.rewrite_rows(top, bottom, lines[top : bottom + 1])
        self.area.move_cursor((top, 0))
        self.query_one("#found", Label).update(f"{len(found)} replaced")

    def action_close(self) -> None:
        """Hide the bar."""
        if self.area is not None:
            self.screen.set_focus(self.area)  # at once: letters typed next belong there
        self.display = False
        self.post_message(self.Closed())
