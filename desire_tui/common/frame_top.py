"""A row of tabs that is the upper line of a pane's frame, too."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.segment import Segment
from rich.style import Style
from textual.reactive import reactive
from textual.strip import Strip
from textual.widget import Widget

if TYPE_CHECKING:
    from collections.abc import Iterable


class FrameTop(Widget):
    """One row; its colour by CSS is that of the frame's lines where the pane does not have the focus."""

    framed: reactive[bool] = reactive(False)
    """Whether the row has the frame's corners."""
    lit: reactive[bool] = reactive(False)
    """Whether the pane has the focus: `:focus-within` reaches only what holds the focus."""

    @property
    def begins(self) -> int:
        """The column where the first tab begins."""
        return 2 if self.framed else 1

    @property
    def room(self) -> int:
        """Columns for tabs and the lines between them."""
        return self.size.width - self.begins - self.framed

    @property
    def line(self) -> Style:
        """What lines are drawn with."""
        return (
            self.rich_style + Style(color=str(self.app.current_theme.primary))
            if self.lit
            else self.rich_style
        )

    def row(self, segments: Iterable[Segment]) -> Strip:
        """Return the row with these segments; lines fill what they leave."""
        line = self.line
        tabs = Strip(segments).crop(0, self.room)
        left = Segment("╭─" if self.framed else "─", line)
        rest = Segment("─" * (self.room - tabs.cell_length) + ("╮" if self.framed else ""), line)
        return Strip([left, *tabs, rest], self.size.width)
