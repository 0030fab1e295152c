"""The sliders of live mode: for each program those parameters that were given one."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual import on
from textual.binding import Binding, BindingType
from textual.containers import VerticalScroll
from textual.message import Message
from textual.widgets import Input

from desire_tui.panes.slider import Slider

if TYPE_CHECKING:
    from collections.abc import Iterable

    from textual.app import ComposeResult


class Sliders(VerticalScroll, can_focus=False):
    """Stacked below the graph; only those of the program shown there are seen."""

    DEFAULT_CSS = """
    Sliders { height: auto; max-height: 8; background: $surface; scrollbar-size-vertical: 1; display: none; }
    Sliders Input { height: 1; border: none; padding: 0 1; background: $panel; color: $accent; display: none;
                    dock: bottom; }
    Sliders Input:focus { border: none; }
    """

    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape", "done", show=False)]

    class Moved(Message):
        """Parameters of live mode changed: re-run with these values."""

        def __init__(self, values: dict[str, float], *, overlay: bool, quantity: str) -> None:
            super().__init__()
            self.values = values
            self.overlay = overlay
            self.quantity = quantity

    class Left(Message):
        """The focus is to go back to the graph."""

    def __init__(self) -> None:
        super().__init__(id="sliders")
        self._overlay = False
        self._program = 0
        self._edited: Slider | None = None

    def compose(self) -> ComposeResult:
        """Have a field for value and limits, hidden."""
        yield Input(id="limits")

    @property
    def shown(self) -> list[Slider]:
        """Those of the program that is shown."""
        return self.of(self._program)

    def of(self, program: int) -> list[Slider]:
        """Return those of the tab of that number."""
        return [slider for slider in self.query(Slider) if slider.program == program]

    def add(self, name: str, value: float, *, label: str = "", program: int) -> None:
        """Give a parameter a slider and move there; one that has it already keeps it."""
        known = next((slider for slider in self.of(program) if slider.quantity == name), None)
        if known is None:
            known = Slider(name, value, label=label, program=program)
            self.mount(known)
        self.show_program(program)
        known.focus()

    def keep(self, program: int, names: Iterable[str]) -> None:
        """Take away a program's sliders but those of these quantities."""
        kept = set(names)
        for slider in self.of(program):
            if slider.quantity not in kept:
                self._remove(slider)
        self.show_program(self._program)

    def show_program(self, program: int) -> None:
        """Show the sliders of one tab."""
        self._program = program
        for slider in self.query(Slider):
            slider.display = slider.program == program
        self.display = bool(self.shown)

    def forget(self, programs: Iterable[int]) -> None:
        """Take away the sliders of all tabs but these."""
        kept = set(programs)
        for slider in list(self.query(Slider)):
            if slider.program not in kept:
                self._remove(slider)

    def toggle_overlay(self) -> bool:
        """Overlay live runs, or replace them; returns which."""
        self._overlay = not self._overlay
        return self._overlay

    def _remove(self, slider: Slider) -> None:
        slider.program = -1  # it goes with the next messages
        slider.remove()

    @on(Slider.Moved)
    def _moved(self, event: Slider.Moved) -> None:
        event.stop()
        values = {slider.quantity: slider.value for slider in self.shown}
        self.post_message(self.Moved(values, overlay=self._overlay, quantity=event.slider.quantity))

    @on(Slider.Left)
    def _left(self, event: Slider.Left) -> None:
        event.stop()
        sliders = self.shown
        at = sliders.index(event.slider) if event.slider in sliders else 0
        if event.removed:
            self._remove(event.slider)
            sliders = self.shown
            self.show_program(self._program)
        elif not event.step:
            sliders = []
        if sliders:
            sliders[min(at if event.removed else (at + event.step) % len(sliders), len(sliders) - 1)].focus()
        else:
            self.post_message(self.Left())

    @on(Slider.EditRequested)
    def _edit(self, event: Slider.EditRequested) -> None:
        event.stop()
        slider, field = event.slider, self.query_one(Input)
        self._edited = slider
        field.value = f"{slider.value:.6g} in {slider.scale.low:.6g} … {slider.scale.high:.6g}"
        field.display = True
        field.focus()
        field.cursor_position = len(f"{slider.value:.6g}")

    @on(Input.Submitted)
    def _edited_now(self, event: Input.Submitted) -> None:
        event.stop()
        slider = self._edited
        if slider is not None:
            typed = slider.scale.typed(event.value, slider.value)
            if typed is None:
                self.app.notify("Type a value, limits, or both: 0.3 in 0 … 2", severity="warning", timeout=3)
                return
            slider.move_to(*typed)
        self.action_done()

    def action_done(self) -> None:
        """Leave the field."""
        self.query_one(Input).display = False
        if self._edited is not None and self._edited.is_attached:
            self._edited.focus()
        self._edited = None
