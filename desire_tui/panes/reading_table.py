"""The table of a graph's read-out, where the values of many curves have no room in one row."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.segment import Segment
from rich.style import Style
from textual.strip import Strip
from textual.widget import Widget

from desire_tui.panes.graph_cursor import valued
from desire_tui.panes.graph_styles import curve_style

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.panes.graph_key_row import KeyRowContent

ROWS_MOST = 8
GAP_CELLS = 3


class ReadingTable(Widget):
    """Names and values in columns; the row of the picked curve is always among those shown."""

    DEFAULT_CSS = "ReadingTable { height: 1; width: 1fr; display: none; }"
    can_focus = False
    ALLOW_SELECT = False

    def __init__(self, content: Callable[[], KeyRowContent]) -> None:
        super().__init__()
        self._content = content
        self._rows = 0
        self.first = 0
        """The first value shown."""
        self.picked: int | None = None
        """Which of the values is the picked curve's."""

    def fit(self, room: int) -> None:
        """Take as many rows as the values need, at most `room` of them; none where one row holds all."""
        content = self._content()
        reading = content.reading
        wanted = 0
        if reading is not None and room > 1 and reading.width > self.container_size.width:
            wanted = min(-(-len(reading.values) // self._columns(self.container_size.width)), room, ROWS_MOST)
        if wanted != self._rows:
            self._rows, self.display = wanted, wanted > 0
            self.styles.height = max(wanted, 1)
        if wanted:
            self.refresh()

    def _columns(self, width: int) -> int:
        reading = self._content().reading
        return max((width + GAP_CELLS) // (self._cell + GAP_CELLS), 1) if reading is not None else 1

    @property
    def _cell(self) -> int:
        reading = self._content().reading
        assert reading is not None
        return 2 + max(len(valued(name, value)) for name, _, value in reading.values)

    @property
    def page_size(self) -> int:
        """How many values are shown at a time."""
        return self.size.height * self._columns(self.size.width)

    def turn(self, pages: int) -> bool:
        """Show values further on or back; False if there are none."""
        reading = self._content().reading
        if not self.display or reading is None:
            return False
        last = max(len(reading.values) - self.page_size, 0)
        first = min(max(self.first + pages * self.page_size, 0), last)
        moved, self.first = first != self.first, first
        self.refresh()
        return moved

    def show_picked(self, picked: int | None) -> None:
        """Mark a value and make sure that it is shown."""
        self.picked = picked
        if picked is not None and self.display:
            columns = self._columns(self.size.width)
            if not self.first <= picked < self.first + self.page_size:
                self.first = picked // columns * columns
        self.refresh()

    def render_line(self, y: int) -> Strip:
        """Draw a row."""
        content = self._content()
        ground, white, reading = content.ground, content.white, content.reading
        width = self.size.width
        if reading is None:
            return Strip.blank(width, ground)
        columns, cell = self._columns(width), self._cell
        start = self.first + y * columns
        segments: list[Segment] = []
        for number in range(start, min(start + columns, len(reading.values))):
            name, color, value = reading.values[number]
            style = ground + Style(reverse=True) if number == self.picked else ground
            text = f" {valued(name, value)}"
            segments.append(Segment("■", ground + curve_style(color, white=white)))
            segments.append(Segment(text.ljust(cell - 1), style))
            segments.append(Segment(" " * GAP_CELLS, ground))
        return Strip(segments).crop(0, width).adjust_cell_length(width, ground)
