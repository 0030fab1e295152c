"""A line at the foot of a terminal that shows how far something is, redrawn in its place."""

from __future__ import annotations

from time import monotonic
from typing import IO

_BAR = 20
_REDRAW_SECONDS = 0.1
_SHOW_AFTER_SECONDS = 0.5


class StatusLine:
    """Shown only if the work takes longer than a blink."""

    def __init__(self, terminal: IO[str]) -> None:
        self._terminal, self._drawn = terminal, monotonic() + _SHOW_AFTER_SECONDS - _REDRAW_SECONDS
        self._is_shown = False

    @property
    def is_due(self) -> bool:
        """Whether it is time to redraw it."""
        return monotonic() - self._drawn >= _REDRAW_SECONDS

    def show(self, text: str) -> None:
        """Redraw it."""
        self._drawn, self._is_shown = monotonic(), True
        self._terminal.write(f"\r\x1b[K{text}")
        self._terminal.flush()

    def clear(self) -> None:
        """Remove it."""
        if self._is_shown:
            self._terminal.write("\r\x1b[K")
            self._terminal.flush()


def bar(part: float) -> str:
    """Return a bar that is full at 1."""
    full = round(_BAR * min(max(part, 0.0), 1.0))
    return f"{'━' * full}{'╌' * (_BAR - full)}"
