"""The part of a graph that is looked at, in frame units: 0 … 1 is what the program asked for."""

from __future__ import annotations

from typing import NamedTuple

SMALLEST = 1e-9


class Window(NamedTuple):
    """left, right, bottom, top."""

    left: float = 0.0
    right: float = 1.0
    bottom: float = 0.0
    top: float = 1.0

    @property
    def is_whole(self) -> bool:
        """Whether it is the program's own scale."""
        return self == (0.0, 1.0, 0.0, 1.0)

    def zoomed(self, factor: float, x: float = 0.5, y: float = 0.5) -> Window:
        """Return a window `factor` times as wide and high.

        The point (x, y), parts of the window, stays in place.
        """
        width, height = (self.right - self.left) * factor, (self.top - self.bottom) * factor
        if min(width, height) < SMALLEST or max(width, height) > 1 / SMALLEST:
            return self
        left = self.left + x * (self.right - self.left) - x * width
        bottom = self.bottom + y * (self.top - self.bottom) - y * height
        return Window(left, left + width, bottom, bottom + height)

    def panned(self, x: float, y: float) -> Window:
        """Return the window moved by parts of itself."""
        dx, dy = x * (self.right - self.left), y * (self.top - self.bottom)
        return Window(self.left + dx, self.right + dx, self.bottom + dy, self.top + dy)

    def part(self, left: float, right: float, bottom: float, top: float) -> Window:
        """Return a part of the window, given in parts of it."""
        width, height = self.right - self.left, self.top - self.bottom
        if (right - left) * width < SMALLEST or (top - bottom) * height < SMALLEST:
            return self
        return Window(
            self.left + left * width,
            self.left + right * width,
            self.bottom + bottom * height,
            self.bottom + top * height,
        )
