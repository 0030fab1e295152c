"""The note of the tour: it lies over the pane it is about, which is marked at its left edge."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.geometry import Offset, Size
from textual.widgets import Static

if TYPE_CHECKING:
    from collections.abc import Callable

    from textual.widget import Widget

    from desire_tui.desktop.layout_rules import Pane

WIDTH, HEIGHT = 36, 7
GRAPH_KEYS = 2
"""Rows of a graph that say what its curves are."""
ROOM = Size(72, 20)
"""The smallest terminal in which the note leaves enough of what it is about."""


def has_room(size: Size) -> bool:
    """Whether a terminal has room for the note."""
    return size.width >= ROOM.width and size.height >= ROOM.height


class TourNote(Static):
    """A sentence about a pane."""

    DEFAULT_CSS = f"""
    TourNote {{ layer: popup; width: {WIDTH}; height: auto; max-height: {HEIGHT}; padding: 0 1;
            background: $panel; color: $foreground; border: round $accent; border-title-color: $accent;
            border-subtitle-color: $foreground; position: absolute; }}
    .-pointed {{ outline-left: thick $accent; }}
    """
    can_focus = False

    def __init__(
        self, pane: Pane, title: str, sentence: str, number: str, leads_on: Callable[[], None]
    ) -> None:
        super().__init__(sentence, markup=False)
        self._pane, self._leads_on = pane, leads_on
        self._stands_at: Offset | None = None
        self.visible = False  # until it stands where it belongs
        self.border_title = f"◀ {title}"
        self.border_subtitle = f"{number} · Alt+N goes on"

    @property
    def target(self) -> Widget:
        """The pane the note is about."""
        return self.screen.query_one(f"#{self._pane}")

    def on_mount(self) -> None:
        """Go to the pane."""
        self.screen.screen_layout_refresh_signal.subscribe(self, lambda _: self._place())
        self.call_after_refresh(self._place)

    def _place(self) -> None:
        """Stand in the lower right corner of the pane, over a graph's keys; above a pane that is low."""
        region, height = self.target.region, self.outer_size.height
        low = region.height < height + 2
        keys = GRAPH_KEYS if self._pane == "graph" else 0
        y = region.y - height if low else region.bottom - height - 1 - keys
        place = Offset(max(region.right - WIDTH - 1, 0), max(y, 0))
        self.visible = bool(region.area)
        if place != self._stands_at:
            self._stands_at = place
            self.styles.offset = (place.x, place.y)

    def on_click(self) -> None:
        """Go on."""
        self._leads_on()
