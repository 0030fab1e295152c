"""What a graph's read-out has come to: the cursor line, the values there, and the curve picked out."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.panes import graph_cursor, picked_curve

if TYPE_CHECKING:
    from desire_tui.engine.graph.curve import Curve
    from desire_tui.engine.graph.model import Graph
    from desire_tui.engine.outputs.braille_canvas import Canvas
    from desire_tui.panes.zoom_window import Window


class Readout:
    """Cursor and picked curve; both belong to a page."""

    def __init__(self) -> None:
        self.cursor: float | None = None
        """Where the cursor line stands, in parts of the window; None: it is not shown."""
        self.reading: graph_cursor.Reading | None = None
        self.picked: Curve | None = None
        self.told = ""
        """What is said of the picked curve."""
        self._hovers = False
        self._drawn: tuple[object, ...] = ()
        self.above: Canvas | None = None
        """The picked curve alone."""

    def clear(self) -> None:
        """Show neither cursor nor picked curve."""
        self.cursor = self.reading = self.picked = self.above = None
        self.told, self._hovers = "", False

    def read(self, page: Graph | None, window: Window) -> bool:
        """Bring the reading up to date; returns whether it is another."""
        before, picked = (self.reading, self.told), self.picked
        self.reading = None
        if page is None:
            self.clear()
        elif picked is not None and picked not in page.curves:
            self.picked, self.told, self._hovers = _same(page, picked), "", False
        if page is not None and self.cursor is not None:
            self.reading = graph_cursor.read(page, window, self.cursor, self.picked)
            if self.picked is not None and not self._hovers:
                self.told = self._told_at_cursor(page, self.picked, window)
        return before != (self.reading, self.told) or picked is not self.picked

    def step(self, page: Graph, by: int) -> None:
        """Pick the curve before or after the picked one."""
        curves = list(page.curves)
        if not curves:
            return
        if self.picked in curves:
            number = min(max(curves.index(self.picked) + by, 0), len(curves) - 1)
        else:
            number = 0 if by > 0 else len(curves) - 1
        self.picked, self._hovers = curves[number], False

    def hover(
        self, page: Graph | None, window: Window, place: tuple[float, float], cells: tuple[int, int]
    ) -> bool:
        """Pick the curve under the mouse, or none; returns whether that changed anything."""
        if page is None or (self.picked is not None and not self._hovers):
            return False  # one was picked with the keys
        before = self.picked, self.told
        found = picked_curve.nearest(page, window, place, cells)
        if found is None:
            self.picked, self.told, self._hovers = None, "", False
        else:
            self.picked, self._hovers = found[0], True
            self.told = graph_cursor.told(page, *found)
        return before != (self.picked, self.told)

    def leave(self) -> bool:
        """Forget what the mouse picked; returns whether there was anything."""
        if not self._hovers:
            return False
        self.picked, self.told, self._hovers = None, "", False
        return True

    def draw(self, page: Graph | None, window: Window, canvas: Canvas | None) -> bool:
        """Draw the picked curve; returns whether it looks different from before."""
        picked = self.picked
        if page is None or canvas is None or picked is None or len(page.curves) < 2:
            changed, self.above, self._drawn = self.above is not None, None, ()
            return changed
        state = (picked, picked.count, page.axes, window, canvas)
        if state == self._drawn:
            return False
        self._drawn = state
        self.above = picked_curve.draw_picked(page, picked, window, canvas)
        return True

    def number(self, page: Graph | None) -> int | None:
        """Return which of the values read is the picked curve's."""
        if page is None or self.picked is None or self.reading is None:
            return None
        curves = list(page.curves)
        if page.frame.kind != "dispt":
            curves = [curve for curve in curves if curve.record is self.picked.record]
        return curves.index(self.picked) if self.picked in curves else None

    def _told_at_cursor(self, page: Graph, curve: Curve, window: Window) -> str:
        assert self.cursor is not None
        number = graph_cursor.sample_at(page, curve, window, self.cursor)
        return "" if number is None else graph_cursor.told(page, curve, number)


def _same(page: Graph, curve: Curve) -> Curve | None:
    """Return what has become of a curve that got another colour."""
    return next(
        (now for now in page.curves if now.record is curve.record and now.y_column == curve.y_column), None
    )
