"""The bottom row: keys when nothing runs; run, time, speed, rule and step while one does."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.segment import Segment
from rich.style import Style
from textual.reactive import reactive
from textual.strip import Strip
from textual.widget import Widget

from desire_tui.engine.session import State, Status

if TYPE_CHECKING:
    from collections.abc import Sequence

BAR_CELLS = 10
KEYS_KEPT = 32
"""Cells that the keys keep beside the run."""
_EIGHTHS = " ▏▎▍▌▋▊▉█"


class StatusBar(Widget):
    """One row. Keys on the left as far as they fit, the run on the right."""

    DEFAULT_CSS = """
    StatusBar { dock: bottom; height: 1; background: $panel; color: $foreground; }
    """
    status: reactive[Status | None] = reactive(None)
    hint: reactive[str] = reactive("")
    """Says what a paused or waiting program expects; replaces the keys."""

    def __init__(self, keys: Sequence[tuple[str, str]]) -> None:
        super().__init__(id="status")
        self.keys = keys

    def render_line(self, y: int) -> Strip:
        """Draw the row."""
        del y
        base = self.rich_style
        theme = self.app.current_theme
        wanted = len(self.hint) + 3 if self.hint else 0
        right = self._run_text(self.size.width - wanted)
        room = self.size.width - len(right) - 1
        key = Style(color=str(theme.primary), bold=True)
        left: list[Segment] = []
        if self.hint:
            left = [Segment(f" {self.hint}"[:room], base + Style(color=str(theme.accent), bold=True))]
        else:
            used = 0
            for name, title in self.keys:
                width = len(name) + len(title) + 3
                if used + width > room:
                    break
                left += [Segment(f" {name}", base + key), Segment(f" {title} ", base)]
                used += width
        strip = Strip(left).adjust_cell_length(max(room, 0), base)
        return Strip.join([strip, Strip([Segment(right + " ", base)], len(right) + 1)]).crop(
            0, self.size.width
        )

    def _run_text(self, room: int) -> str:
        """Return what is known of the run, as much as fits; the least important goes first."""
        status = self.status
        if status is None or (status.state is State.IDLE and not status.run):
            return ""
        going = status.state in (State.RUNNING, State.PAUSED)
        parts = [f"{status.state.value} {status.run}" if going else f"run {status.run}"]
        if going:
            parts.append(f"{_bar(status.progress)} t {status.t:.4g}/{status.t0 + status.t_max:.4g}")
        elif status.state is State.IDLE:
            parts.append(f"t {status.t:.4g}")
        else:
            parts.insert(0, status.state.value)
        parts += [f"{speed(status.steps_per_second)} steps/s", f"rule {status.rule}", f"DT {status.dt:.3g}"]
        while len(parts) > 1 and len(" · ".join(parts)) > min(room, max(room - KEYS_KEPT, BAR_CELLS)):
            parts.pop()
        return " · ".join(parts)[: max(room, 0)]


def _bar(progress: float) -> str:
    eighths = round(progress * BAR_CELLS * 8)
    full, part = divmod(eighths, 8)
    return ("█" * full + (_EIGHTHS[part] if full < BAR_CELLS else "")).ljust(BAR_CELLS, "·")


def speed(per_second: float) -> str:
    """Return a number with its thousands as k, M, G."""
    for unit in ("", "k", "M"):
        if abs(per_second) < 1000:
            return f"{per_second:.3g} {unit}".rstrip()
        per_second /= 1000
    return f"{per_second:.3g} G"
