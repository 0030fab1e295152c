"""The row of tabs above the editors."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.segment import Segment
from rich.style import Style
from textual.message import Message
from textual.reactive import reactive

from desire_tui.common import themes
from desire_tui.common.frame_top import FrameTop
from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.visible_text import visible_line

if TYPE_CHECKING:
    from collections.abc import Iterator

    from textual import events
    from textual.strip import Strip

NEW, LEFT, RIGHT = -1, -2, -3


@dataclass(frozen=True, slots=True)
class TabLabel:
    """What a tab shows."""

    key: int
    name: str
    dirty: bool
    active: bool
    """Whether it holds the active program."""


class TabStrip(FrameTop):
    """One row: `─ step.src ● │ torpedo.src │ + ────`. Scrolls so that the front tab is seen."""

    DEFAULT_CSS = """
    TabStrip { height: 1; width: 1fr; background: $surface; color: $frame; }
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

    class Dragged(Message):
        """A tab (`key`) was dragged to the place of another (`over`)."""

        def __init__(self, key: int, over: int) -> None:
            super().__init__()
            self.key = key
            self.over = over

    def __init__(self) -> None:
        super().__init__()
        self._held: int | None = None

    def _pieces(self) -> list[tuple[int, str]]:
        """Tab keys with their texts, as many as fit, the front one among them."""
        texts = [
            (t.key, f" {'▸' if t.active else ''}{visible_line(t.name)}{' ●' if t.dirty else ''} ")
            for t in self.tabs
        ]
        room = self.room - len(" + ") - 2
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
        line = self.line
        theme = self.app.current_theme
        front = line + Style(color=str(theme.accent), bold=True)
        second = line + Style(color=str(theme.foreground), bold=True)
        other = line + Style(color=themes.quiet(theme))
        segments: list[Segment] = []
        for key, text in self._pieces():
            style = front if key == self.front else second if key == self.second else other
            segments += [Segment("│", line)] if segments else []
            segments.append(Segment(text, style))
        return self.row(segments)

    def _at(self, x: int) -> tuple[int, int, int] | None:
        """Return the tab (or sign) at a column, with the columns it begins and ends at."""
        for key, left, right in self._columns():
            if left <= x < right:
                return key, left, right
        return None

    def places(self) -> list[tuple[int, int]]:
        """Return tabs (and the sign for a new one, below 0) with the column of each."""
        return [(key, left) for key, left, _ in self._columns() if key >= 0 or key == NEW]

    def _columns(self) -> Iterator[tuple[int, int, int]]:
        left = self.begins
        for key, text in self._pieces():
            yield key, left, left + len(text)
            left += len(text) + 1

    def on_click(self, event: events.Click) -> None:
        """Choose the tab under the mouse; the middle button closes it."""
        found = self._at(event.x)
        if found is None:
            return
        key, keys = found[0], [tab.key for tab in self.tabs]
        shown = [k for k, _ in self._pieces() if k >= 0]
        if key == LEFT:
            key = keys[keys.index(shown[0]) - 1]
        elif key == RIGHT:
            key = keys[keys.index(shown[-1]) + 1]
        self.post_message(self.Chosen(key, close=event.button == 2 and key >= 0))

    def on_mouse_down(self, event: events.MouseDown) -> None:
        """Take hold of a tab."""
        found = self._at(event.x)
        if event.button == 1 and found is not None and found[0] >= 0:
            self._held = found[0]
            self.capture_mouse()

    def on_mouse_move(self, event: events.MouseMove) -> None:
        """Drag the tab that is held past others, so that it stays under the mouse."""
        over = self._at(event.x) if self._held is not None else None
        if over is None or self._held is None or over[0] < 0 or over[0] == self._held:
            return
        keys = [tab.key for tab in self.tabs]
        width = next((len(text) for key, text in self._pieces() if key == self._held), 0)
        key, left, right = over
        rightward = keys.index(key) > keys.index(self._held)
        if event.x >= right - width if rightward else event.x < left + width:
            self.post_message(self.Dragged(self._held, key))

    def on_mouse_up(self) -> None:
        """Let go."""
        self._held = None
        self.release_mouse()
