"""Command lines that wait because one before them failed: seen above the prompt, edited in it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.segment import Segment
from rich.style import Style
from textual.strip import Strip
from textual.widget import Widget

from desire_tui.engine.visible_text import visible_line

if TYPE_CHECKING:
    from collections.abc import Sequence

ROWS_MAX = 6


class PendingLines(Widget):
    """The lines, the one that stands in the prompt marked. Hidden while there are none."""

    DEFAULT_CSS = """
    PendingLines { height: auto; width: 1fr; display: none; background: $panel; color: $foreground; }
    """
    can_focus = False

    def __init__(self) -> None:
        super().__init__(id="pending-lines")
        self._lines: list[str] = []
        self._at = 0

    def keep(self, lines: Sequence[str]) -> None:
        """Keep these lines; the first one belongs into the prompt."""
        self._lines, self._at = list(lines), 0
        self._draw()

    @property
    def is_empty(self) -> bool:
        """Whether nothing is kept."""
        return not self._lines

    def step(self, by: int, typed: str) -> str | None:
        """Put the prompt's text back in its place; return the line after or before it, None at an end."""
        if not 0 <= self._at + by < len(self._lines):
            return None
        self._lines[self._at] = typed
        self._at += by
        self._draw()
        return self._lines[self._at]

    def take(self, typed: str = "") -> list[str]:
        """Return the lines, as edited, and keep none."""
        lines, self._lines = self._lines, []
        if lines:
            lines[self._at] = typed
        self._at = 0
        self._draw()
        return [line for line in lines if line.strip()]

    def _draw(self) -> None:
        self.display = bool(self._lines)
        self.styles.height = min(len(self._lines), ROWS_MAX)
        self.refresh(layout=True)

    def render_line(self, y: int) -> Strip:
        """Draw a row."""
        base = self.rich_style
        first = min(max(self._at - ROWS_MAX // 2, 0), max(len(self._lines) - ROWS_MAX, 0))
        number = first + y
        if number >= len(self._lines):
            return Strip.blank(self.size.width, base)
        here = number == self._at
        style = base + Style(color=str(self.app.current_theme.accent), bold=True) if here else base
        text = f" {'▸' if here else ' '} {visible_line(self._lines[number])}"[: self.size.width]
        return Strip([Segment(text, style)]).adjust_cell_length(self.size.width, base)
