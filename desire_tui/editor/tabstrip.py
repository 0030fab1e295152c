"""The row of tabs above the editors."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rich.segment import Segment
from rich.style import Style
from textual.message import Message
from textual.reactive import reactive
from textual.strip import Strip
from textual.widget import Widget

if TYPE_CHECKING:
    from textual import events

NEW, LEFT, RIGHT = -1, -2, -3


@dataclass(frozen=True, slots=True)
class TabLabel:
    """What a tab shows."""

    key: int
    name: str
    dirty: bool
    active: bool
    """Whether it holds the active program."""


class TabStrip(Widget):
    """One row: ` step.src ● │ torpedo.src │ + `. Scrolls so that the front tab is seen."""

    DEFAULT_CSS = """
    TabStrip { height: 1; width: 1fr; background: $panel; color: $text-muted; }
    """
    tabs: reactive[tuple[TabLabel, ...]] = reactive(())
    front: reactive[int] = reactive(0)
    second: reactive[int | None] = reactive(None)

    class Chosen(Message):
        """A tab was clicked (`key` < 0: the sign for a new one)."""

        def __init__(self, key: int, *, close: bool = False) -> None:
            super().__init__()
            self.key = key
            self.close = close

    def _pieces(self) -> list[tuple[int, str]]:
        """Tab keys with their texts, as many as fit, the front one among them."""
        texts = [(t.key, f" {'▸' if t.active else ''}{t.name}{' ●' if t.dirty else ''} ") for t in self.tabs]
        room = self.size.width - 5
        keys = [key for key, _ in texts]
        first = last = keys.index(self.front) if self.front in keys else 0
        if not texts:
            return [(NEW, " + ")]
        room -= len(texts[first][1]) + 1
        while True:
            if first > 0 and len(texts[first - 1][1]) + 1 <= room:
                first -= 1
                room -= len(texts[first][1]) + 1
            elif last + 1 < len(texts) and len(texts[last + 1][1]) + 1 <= room:
                last += 1
                room -= len(texts[last][1]) + 1
            else:
                break
        pieces = texts[first : last + 1]
        if first > 0:
            pieces.insert(0, (LEFT, "‹"))
        if last + 1 < len(texts):
            pieces.append((RIGHT, "›"))
        return [*pieces, (NEW, " + ")]

    def render_line(self, y: int) -> Strip:
        """Draw the row."""
        del y
        base = self.rich_style
        theme = self.app.current_theme
        front = Style(color=str(theme.foreground), bgcolor=str(theme.surface), bold=True)
        second = Style(color=str(theme.foreground), bgcolor=str(theme.surface))
        segments = []
        for key, text in self._pieces():
            style = front if key == self.front else second if key == self.second else base
            segments += [Segment(text, style), Segment("│", base)]
        width = sum(len(segment.text) for segment in segments)
        return Strip(segments, width).adjust_cell_length(self.size.width, base)

    def on_click(self, event: events.Click) -> None:
        """Choose the tab under the mouse; the middle button closes it."""
        x = 0
        keys = [tab.key for tab in self.tabs]
        for key, text in self._pieces():
            if x <= event.x < x + len(text):
                shown = [k for k, _ in self._pieces() if k >= 0]
                if key == LEFT:
                    key = keys[keys.index(shown[0]) - 1]  # noqa: PLW2901 - the tab the sign stands for
                elif key == RIGHT:
                    key = keys[keys.index(shown[-1]) + 1]  # noqa: PLW2901 - as above
                self.post_message(self.Chosen(key, close=event.button == 2 and key >= 0))
                return
            x += len(text) + 1
