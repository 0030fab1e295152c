"""The bottom row: keys on the left, the run on the right. A click on a key presses it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rich.segment import Segment
from rich.style import Style
from textual.message import Message
from textual.reactive import reactive
from textual.strip import Strip
from textual.widget import Widget

from desire_tui.engine.session.status import State
from desire_tui.panes.run_summary import run_text

if TYPE_CHECKING:
    from collections.abc import Sequence

    from textual import events

    from desire_tui.engine.session.status import Status

KEYS_KEPT, KEYS_PART = 32, 0.45
"""Cells, or part of the row, that the keys keep beside the run."""
KEYS_GOING = 12
"""Cells they keep while a run goes on: its numbers matter more then."""
RUN_KEPT = 10
PAUSE = "run.pause"
REPORT = "run.report"
"""What a click on the run does."""


class KeyHint(NamedTuple):
    """A key as shown, a word for what it does, and the action."""

    key: str
    title: str
    command_id: str


class StatusBar(Widget):
    """One row. Keys on the left as far as they fit, the run on the right."""

    DEFAULT_CSS = """
    StatusBar { dock: bottom; height: 1; background: $panel; color: $foreground; }
    """
    status: reactive[Status | None] = reactive(None)
    failed: reactive[str] = reactive("")
    """Says that a program ended before its first run: what stands here otherwise is of the one before."""
    hint: reactive[str] = reactive("")
    """Says what a paused or waiting program expects; replaces the keys."""

    class Clicked(Message):
        """An action was clicked."""

        def __init__(self, command_id: str) -> None:
            super().__init__()
            self.command_id = command_id

    def __init__(self, keys: Sequence[KeyHint]) -> None:
        super().__init__(id="status")
        self.keys = keys

    @property
    def text(self) -> str:
        """What the right side says of the run."""
        width = self.size.width - (len(self.hint) + 3 if self.hint else 0)
        keys = 0 if self.hint else KEYS_GOING if self._going else max(KEYS_KEPT, int(width * KEYS_PART))
        if self.failed and self.status is not None and self.status.state is State.IDLE:
            return self.failed[: max(width - keys, RUN_KEPT)]
        return run_text(self.status, min(width, max(width - keys, RUN_KEPT)))

    @property
    def _going(self) -> bool:
        return self.status is not None and self.status.state is State.RUNNING

    def _shown_keys(self, room: int) -> list[tuple[KeyHint, int]]:
        """Keys that fit, with the cell where each begins."""
        shown, used = [], 0
        for hint in (
            sorted(self.keys, key=lambda hint: hint.command_id != PAUSE) if self._going else self.keys
        ):
            width = len(hint.key) + len(hint.title) + 3
            if used + width > room:
                break
            shown.append((hint, used))
            used += width
        return shown

    def render_line(self, y: int) -> Strip:
        """Draw the row."""
        del y
        base = self.rich_style
        theme = self.app.current_theme
        right = self.text
        room = self.size.width - len(right) - 1
        key = Style(color=str(theme.primary), bold=True)
        left: list[Segment] = []
        if self.hint:
            left = [Segment(f" {self.hint}"[:room], base + Style(color=str(theme.accent), bold=True))]
        else:
            for hint, _ in self._shown_keys(room):
                left += [Segment(f" {hint.key}", base + key), Segment(f" {hint.title} ", base)]
        strip = Strip(left).adjust_cell_length(max(room, 0), base)
        return Strip.join([strip, Strip([Segment(right + " ", base)], len(right) + 1)]).crop(
            0, self.size.width
        )

    def on_click(self, event: events.Click) -> None:
        """Press the key under the mouse; on the run: what it did."""
        right = self.text
        room = self.size.width - len(right) - 1
        if event.x >= room:
            if right:
                self.post_message(self.Clicked(REPORT))
            return
        if self.hint:
            return
        for hint, start in reversed(self._shown_keys(room)):
            if event.x >= start:
                if event.x < start + len(hint.key) + len(hint.title) + 2:
                    self.post_message(self.Clicked(hint.command_id))
                return
