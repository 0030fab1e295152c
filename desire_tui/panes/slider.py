"""A slider for one parameter."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from rich.segment import Segment
from rich.style import Style
from textual.binding import Binding, BindingType
from textual.message import Message
from textual.reactive import reactive
from textual.strip import Strip
from textual.widget import Widget

if TYPE_CHECKING:
    from textual import events

STEPS = 100
NAME_CELLS, VALUE_CELLS = 10, 11


class Slider(Widget, can_focus=True):
    """`r ───●─── 10`: arrows step, Shift and arrows step by ten, `+` and `-` widen and narrow the range.

    The range starts as 0 … twice the value (−1 … 1 for 0).
    """

    DEFAULT_CSS = """
    Slider { height: 1; padding: 0 1; color: $foreground; }
    Slider:focus { background: $boost; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("right", "step(1)", show=False),
        Binding("left", "step(-1)", show=False),
        Binding("shift+right", "step(10)", show=False),
        Binding("shift+left", "step(-10)", show=False),
        Binding("plus,equals_sign", "widen(2)", show=False),
        Binding("minus", "widen(0.5)", show=False),
        Binding("home,0", "reset", show=False),
        Binding("down", "app.focus_next", show=False),
        Binding("up", "app.focus_previous", show=False),
    ]
    value: reactive[float] = reactive(0.0)

    class Moved(Message):
        """The value changed."""

    def __init__(self, quantity: str, value: float) -> None:
        super().__init__()
        self.quantity = quantity
        self.start = value
        span = abs(value) or 1.0
        self.low, self.high = (0.0, 2 * value) if value > 0 else (value - span, value + span)
        self.set_reactive(Slider.value, value)

    @property
    def _track(self) -> int:
        return max(self.size.width - NAME_CELLS - VALUE_CELLS, 4)

    def render_line(self, y: int) -> Strip:
        """Draw the row."""
        del y
        base = self.rich_style
        theme = self.app.current_theme
        part = (self.value - self.low) / ((self.high - self.low) or 1.0)
        at = min(max(round(part * (self._track - 1)), 0), self._track - 1)
        knob = base + Style(color=str(theme.accent), bold=True)
        segments = [
            Segment(f"{self.quantity[: NAME_CELLS - 1]:<{NAME_CELLS}}", base + Style(bold=self.has_focus)),
            Segment("━" * at, base + Style(color=str(theme.primary))),
            Segment("●", knob),
            Segment("─" * (self._track - 1 - at), base + Style(color=str(theme.secondary))),
            Segment(f"{self.value:>{VALUE_CELLS}.5g}", base),
        ]
        return Strip(segments).adjust_cell_length(self.size.width, base)

    def _set(self, value: float) -> None:
        if value != self.value:
            self.value = value
            self.post_message(self.Moved())

    def action_step(self, steps: int) -> None:
        """Move by hundredths of the range; past an end the range follows."""
        value = self.value + steps * (self.high - self.low) / STEPS
        value = float(f"{value:.6g}")
        if value < self.low - 1e-12 * abs(self.low) or value > self.high + 1e-12 * abs(self.high):
            self.low, self.high = min(self.low, value), max(self.high, value)
        self._set(value)

    def action_widen(self, factor: float) -> None:
        """Make the range wider or narrower around the value."""
        half = (self.high - self.low) / 2 * factor
        self.low, self.high = self.value - half, self.value + half
        self.refresh()

    def action_reset(self) -> None:
        """Back to the value at the start."""
        self._set(self.start)

    def on_mouse_down(self, event: events.MouseDown) -> None:
        """Jump to the mouse and follow it."""
        self.capture_mouse()
        self._follow(event.x)

    def on_mouse_move(self, event: events.MouseMove) -> None:
        """Follow the mouse while a button is down."""
        if self.app.mouse_captured is self:
            self._follow(event.x)

    def on_mouse_up(self) -> None:
        """Let the mouse go."""
        self.release_mouse()

    def _follow(self, x: int) -> None:
        part = min(max((x - 1 - NAME_CELLS) / max(self._track - 1, 1), 0.0), 1.0)
        self._set(float(f"{self.low + part * (self.high - self.low):.4g}"))
