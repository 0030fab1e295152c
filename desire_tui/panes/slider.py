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

from desire_tui.panes.slider_scale import SliderScale

if TYPE_CHECKING:
    from textual import events

NARROW_BELOW = 56
"""On fewer columns names, limits and value have less room."""


class Slider(Widget, can_focus=True):
    """`r   0 ├───●─────┤ 40    10`: name, lower limit, track, upper limit, value."""

    DEFAULT_CSS = """
    Slider { height: 1; padding: 0 1; color: $foreground; }
    Slider:focus { background: $boost; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("right", "step(1)", "step", show=False),
        Binding("left", "step(-1)", "step back", show=False),
        Binding("shift+right", "step(10)", "ten steps", show=False),
        Binding("shift+left", "step(-10)", "ten steps back", show=False),
        Binding("plus,equals_sign", "widen(2)", "wider range", show=False),
        Binding("minus", "widen(0.5)", "narrower range", show=False),
        Binding("home,0", "reset", "back to the program's value", show=False),
        Binding("l", "log", "logarithmic, or linear again", show=False),
        Binding("enter", "edit", "type value and limits", show=False),
        Binding("w", "app.do('run.live_write')", "write into the program", show=False),
        Binding("c", "app.do('analysis.over')", "steady states and cycles over its range", show=False),
        Binding("o", "app.do('run.live_overlay')", "overlay or replace", show=False),
        Binding("delete,backspace", "remove", "take the slider away", show=False),
        Binding("escape", "leave", "leave the sliders", show=False),
        Binding("down", "neighbour(1)", "next slider", show=False),
        Binding("up", "neighbour(-1)", "slider before", show=False),
    ]
    value: reactive[float] = reactive(0.0)

    class Moved(Message):
        """The value changed."""

        def __init__(self, slider: Slider) -> None:
            super().__init__()
            self.slider = slider

    class EditRequested(Message):
        """Value and limits are to be typed."""

        def __init__(self, slider: Slider) -> None:
            super().__init__()
            self.slider = slider

    class Left(Message):
        """The user is done with the sliders, or with this one (`removed`), or goes to the next (`step`)."""

        def __init__(self, slider: Slider, *, step: int = 0, removed: bool = False) -> None:
            super().__init__()
            self.slider, self.step, self.removed = slider, step, removed

    def __init__(self, quantity: str, value: float, *, label: str = "", program: int = 0) -> None:
        """`program` is the number of the tab it belongs to, `label` what it is called (`x(0)`)."""
        super().__init__()
        self.quantity, self.label, self.program = quantity, label or quantity, program
        self.start = value
        """The program's own value."""
        self.scale = SliderScale.around(value)
        self.set_reactive(Slider.value, value)

    @property
    def _cells(self) -> tuple[int, int, int]:
        """Cells of the name, of each limit and of the value."""
        return (7, 5, 8) if self.size.width < NARROW_BELOW else (12, 8, 11)

    @property
    def _track(self) -> tuple[int, int]:
        """First cell and length of the track."""
        name, limit, value = self._cells
        first = name + limit + 2
        return first, max(self.size.width - first - limit - value - 2, 3)

    def render_line(self, y: int) -> Strip:
        """Draw the row."""
        del y
        base, theme = self.rich_style, self.app.current_theme
        name, limit, value = self._cells
        _, track = self._track
        at = round(self.scale.part(self.value) * (track - 1))
        before = round(self.scale.part(self.start) * (track - 1))
        line = ["━" if cell < at else "─" for cell in range(track)]
        if before != at:
            line[before] = "╵"  # the program's value
        faint = base + Style(color=str(theme.secondary))
        word = "log " if self.scale.is_log else ""
        segments = [
            Segment(f"{self.label[: name - 1]:<{name}}", base + Style(bold=self.has_focus)),
            Segment(f"{self.scale.low:>{limit}.3g} ", base),
            Segment("├", faint),
            Segment("".join(line[:at]), base + Style(color=str(theme.primary))),
            Segment("●", base + Style(color=str(theme.accent), bold=True)),
            Segment("".join(line[at + 1 :]), faint),
            Segment("┤", faint),
            Segment(f" {self.scale.high:<{limit}.3g}", base),
            Segment(f"{word}{self.value:.5g}".rjust(value), base),
        ]
        return Strip(segments).adjust_cell_length(self.size.width, base)

    def move_to(self, value: float, scale: SliderScale | None = None) -> None:
        """Take a value, and have the program run with it."""
        self.scale = scale or self.scale.holding(value)
        self.refresh()
        if value != self.value:
            self.value = value
            self.post_message(self.Moved(self))

    def agree(self, value: float, *, is_own: bool) -> None:
        """Show the value that a run used; `is_own`: it was the program's."""
        if is_own:
            self.start = value
        if value != self.value:
            self.scale = self.scale.holding(value)
            self.value = value
        self.refresh()

    def action_step(self, steps: int) -> None:
        """Move by hundredths of the range; past an end the range follows."""
        self.move_to(self.scale.stepped(self.value, steps))

    def action_widen(self, factor: float) -> None:
        """Make the range wider or narrower around the value."""
        self.scale = self.scale.widened(factor, self.value)
        self.refresh()

    def action_reset(self) -> None:
        """Back to the program's value."""
        self.move_to(self.start)

    def action_log(self) -> None:
        """Make the range logarithmic, or linear again."""
        toggled = self.scale.toggled(self.value)
        if toggled is None:
            self.app.notify("Only values above 0 have a logarithmic range.", timeout=3)
        else:
            self.scale = toggled
            self.refresh()

    def action_edit(self) -> None:
        """Have value and limits typed."""
        self.post_message(self.EditRequested(self))

    def action_remove(self) -> None:
        """Take it away."""
        self.post_message(self.Left(self, removed=True))

    def action_leave(self) -> None:
        """Go back to the graph."""
        self.post_message(self.Left(self))

    def action_neighbour(self, step: int) -> None:
        """Move to the next slider, or the one before."""
        self.post_message(self.Left(self, step=step))

    def on_mouse_down(self, event: events.MouseDown) -> None:
        """Jump to the mouse and follow it; beside the track, have the numbers typed."""
        event.stop()
        first, track = self._track
        if first <= event.x - 1 < first + track:
            self.capture_mouse()
            self._follow(event.x)
        elif event.x - 1 >= self._cells[0]:
            self.action_edit()

    def on_mouse_move(self, event: events.MouseMove) -> None:
        """Follow the mouse while a button is down."""
        event.stop()
        if self.app.mouse_captured is self:
            self._follow(event.x)

    def on_mouse_up(self, event: events.MouseUp) -> None:
        """Let the mouse go."""
        event.stop()
        self.release_mouse()

    def _follow(self, x: int) -> None:
        first, track = self._track
        self.move_to(self.scale.at((x - 1 - first) / max(track - 1, 1), max(track - 1, 1)))
