"""The row below a graph: its colour keys, or the values at the cursor."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rich.segment import Segment
from rich.style import Style
from textual.strip import Strip
from textual.widget import Widget

from desire_tui.panes.graph_styles import curve_style

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from desire_tui.panes.graph_cursor import Reading


class KeyRowContent(NamedTuple):
    """What the row shows; a reading takes the place of the keys."""

    ground: Style
    white: bool
    keys: Iterable[tuple[str, int]]
    """Names with their colours."""
    reading: Reading | None


class KeyRow(Widget):
    """Asks for its content whenever it is drawn."""

    DEFAULT_CSS = "KeyRow { height: 1; width: 1fr; dock: bottom; }"
    can_focus = False
    ALLOW_SELECT = False

    def __init__(self, content: Callable[[], KeyRowContent]) -> None:
        super().__init__()
        self._content = content

    def render_line(self, y: int) -> Strip:
        """Draw the row."""
        del y
        ground, white, keys, reading = self._content()
        width = self.size.width
        segments: list[Segment] = []
        if reading is not None:
            segments.append(Segment(f" {reading.head} ", ground + Style(bold=True)))
            for name, color, value in reading.values:
                segments.append(Segment(" ■", ground + curve_style(color, white=white)))
                segments.append(Segment(f" {name} = {value}", ground))
        else:
            for name, color in keys:
                segments.append(Segment(" ■ ", ground + curve_style(color, white=white)))
                segments.append(Segment(name, ground))
        used = sum(segment.cell_length for segment in segments)
        pad = max((width - used) // 2, 0) if reading is None else 0
        strip = Strip([Segment(" " * pad, ground), *segments])
        if strip.cell_length > width:
            strip = Strip.join([strip.crop(0, width - 1), Strip([Segment("…", ground)], 1)])
        return strip.adjust_cell_length(width, ground)
