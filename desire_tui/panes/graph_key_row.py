"""The row below a graph: its colour keys, or the values at the cursor, or what is said of a picked curve."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rich.segment import Segment
from rich.style import Style
from textual.strip import Strip
from textual.widget import Widget

from desire_tui.panes.graph_cursor import valued
from desire_tui.panes.graph_styles import curve_style

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from desire_tui.engine.graph.color_keys import Key
    from desire_tui.panes.graph_cursor import Reading


class KeyRowContent(NamedTuple):
    """What the row shows: what is told of a picked curve, or a reading, or else the keys."""

    ground: Style
    white: bool
    keys: Sequence[Key]
    reading: Reading | None
    told: str = ""
    told_color: int = 0


class KeyRow(Widget):
    """Asks for its content whenever it is drawn."""

    DEFAULT_CSS = "KeyRow { height: 1; width: 1fr; }"
    can_focus = False
    ALLOW_SELECT = False

    def __init__(self, content: Callable[[], KeyRowContent]) -> None:
        super().__init__()
        self._content = content

    def render_line(self, y: int) -> Strip:
        """Draw the row."""
        del y
        ground, white, keys, reading, told, color = self._content()
        width = self.size.width
        segments: list[Segment] = []
        if told:
            segments = [Segment(" ■", ground + curve_style(color, white=white)), Segment(f" {told}", ground)]
        elif reading is not None and reading.width > width:
            segments.append(Segment(f" {reading.head} ", ground + Style(bold=True)))
            segments.append(Segment(f" {len(reading.values)} curves · ↑ ↓ pick one", ground))
        elif reading is not None:
            segments.append(Segment(f" {reading.head} ", ground + Style(bold=True)))
            for name, color, value in reading.values:
                segments.append(Segment(" ■", ground + curve_style(color, white=white)))
                segments.append(Segment(f" {valued(name, value)}", ground))
        else:
            segments += key_segments(keys, ground, width, white=white)
        used = sum(segment.cell_length for segment in segments)
        pad = max((width - used) // 2, 0) if reading is None and not told else 0
        strip = Strip([Segment(" " * pad, ground), *segments])
        if strip.cell_length > width:
            strip = Strip.join([strip.crop(0, width - 1), Strip([Segment("…", ground)], 1)])
        return strip.adjust_cell_length(width, ground)


def key_segments(keys: Sequence[Key], ground: Style, width: int, *, white: bool) -> list[Segment]:
    """Return colour keys as a row of text; without room, what neighbours share is left out."""
    from desire_tui.engine.graph.color_keys import short_names

    names = [key.name for key in keys]
    if sum(len(key.name) + len(key.colors) + 2 for key in keys) > width:
        names = short_names(keys)
    segments = []
    for key, name in zip(keys, names, strict=True):
        segments.append(Segment(" ", ground))
        segments += [Segment(key.sign, ground + curve_style(color, white=white)) for color in key.colors]
        segments.append(Segment(f" {name}", ground))
    return segments
