"""What the mouse does in a graph: mark a part to zoom into, set the cursor, pause, zoom by the wheel."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.geometry import Region
from textual.message import Message

from desire_tui.panes.drawn_graph import DrawnGraph

if TYPE_CHECKING:
    from textual import events

DRAG_CELLS_MIN = 2


class MouseGestures(DrawnGraph):
    """The part of a graph pane that handles the mouse."""

    _drag: tuple[int, int] | None = None
    """Cell where the rectangle being marked begins."""

    class PauseRequested(Message):
        """The graph was clicked twice."""

    class Pointed(Message):
        """The graph was clicked at a place, given in parts of its frame from the left and from below."""

        def __init__(self, x: float, y: float) -> None:
            super().__init__()
            self.x, self.y = x, y

    def set_cursor(self, x: float) -> None:
        """Move the cursor line, if it is shown, to x (part of the window)."""
        raise NotImplementedError

    def hover(self, x: float, y: float) -> None:
        """Pick the curve at a place, given in parts of the window."""
        raise NotImplementedError

    def on_mouse_down(self, event: events.MouseDown) -> None:
        """Begin a rectangle to zoom into."""
        if event.button == 1 and (cell := self._cell(event)) is not None:
            self._drag = cell
            self.capture_mouse()

    def on_mouse_move(self, event: events.MouseMove) -> None:
        """Show the rectangle; without a button, pick the curve under the mouse."""
        if (cell := self._cell(event)) is None or self.canvas is None:
            return
        if self._drag is None:
            if not self._is_inside(event):
                return
            self.hover((cell[0] + 0.5) / self.canvas.columns, 1 - (cell[1] + 0.5) / self.canvas.rows)
            return
        (x1, x2), (y1, y2) = sorted((self._drag[0], cell[0])), sorted((self._drag[1], cell[1]))
        self.rubber = Region(x1, y1, x2 - x1 + 1, y2 - y1 + 1)
        self.mark_cells()

    def on_mouse_up(self, event: events.MouseUp) -> None:
        """Zoom into the rectangle; a plain click puts the cursor there."""
        self.release_mouse()
        box, self.rubber = self.rubber, None
        drag, self._drag = self._drag, None
        if self.canvas is None or drag is None:
            return
        columns, rows = self.canvas.columns, self.canvas.rows
        if box is not None and box.width > DRAG_CELLS_MIN and box.height > 1:
            bottom, top = 1 - box.bottom / rows, 1 - box.y / rows
            self.look_at(self.view.part(box.x / columns, box.right / columns, bottom, top))
        elif (cell := self._cell(event)) is not None:
            across, up, view = (cell[0] + 0.5) / columns, 1 - (cell[1] + 0.5) / rows, self.view
            self.set_cursor(across)
            self.post_message(self.Pointed(
                view.left + across * (view.right - view.left), view.bottom + up * (view.top - view.bottom),
            ))  # fmt: skip
        self.mark_cells()

    def on_click(self, event: events.Click) -> None:
        """Two clicks pause the run."""
        if event.chain == 2:
            self.post_message(self.PauseRequested())

    def on_mouse_scroll_up(self, event: events.MouseScrollUp) -> None:
        """Zoom in at the mouse."""
        self._wheel(event, 0.8)

    def on_mouse_scroll_down(self, event: events.MouseScrollDown) -> None:
        """Zoom out at the mouse."""
        self._wheel(event, 1.25)

    def _wheel(self, event: events.MouseEvent, factor: float) -> None:
        event.stop()
        if (cell := self._cell(event)) is not None and self.canvas is not None:
            x, y = (cell[0] + 0.5) / self.canvas.columns, 1 - (cell[1] + 0.5) / self.canvas.rows
            self.look_at(self.view.zoomed(factor, x, y))

    def _is_inside(self, event: events.MouseEvent) -> bool:
        """Whether the mouse is on the canvas."""
        if self.frame is None or self.canvas is None:
            return False
        x, y = self.frame.left + self.content_region.x, self.frame.top + self.content_region.y
        return Region(x, y, self.canvas.columns, self.canvas.rows).contains(
            int(event.screen_x), int(event.screen_y)
        )

    def _cell(self, event: events.MouseEvent) -> tuple[int, int] | None:
        """Cell of the canvas under the mouse."""
        if self.frame is None or self.canvas is None:
            return None
        origin = self.content_region
        x = int(event.screen_x) - origin.x - self.frame.left
        y = int(event.screen_y) - origin.y - self.frame.top
        return min(max(x, 0), self.canvas.columns - 1), min(max(y, 0), self.canvas.rows - 1)
