"""The sliders of live mode: one for each parameter that was given one."""

from __future__ import annotations

from textual import on
from textual.containers import VerticalScroll
from textual.message import Message

from desire_tui.panes.slider import Slider


class Sliders(VerticalScroll):
    """Stacked below the table of quantities."""

    DEFAULT_CSS = """
    Sliders { height: auto; max-height: 40%; background: $surface; }
    """

    class Moved(Message):
        """Parameters of live mode changed: re-run with these values."""

        def __init__(self, values: dict[str, float], *, overlay: bool) -> None:
            super().__init__()
            self.values = values
            self.overlay = overlay

    def __init__(self) -> None:
        super().__init__(id="sliders")
        self._overlay = False

    def add(self, name: str, value: float) -> None:
        """Give a parameter a slider and move there; one that has it already keeps it."""
        known = next((slider for slider in self.query(Slider) if slider.quantity == name), None)
        if known is None:
            known = Slider(name, value)
            self.mount(known)
        known.focus()

    def remove_focused(self) -> bool:
        """Take away the slider that has the focus; False if none has."""
        focused = self.screen.focused
        if not isinstance(focused, Slider):
            return False
        focused.remove()
        return True

    def toggle_overlay(self) -> bool:
        """Overlay live runs, or replace them; returns which."""
        self._overlay = not self._overlay
        return self._overlay

    @on(Slider.Moved)
    def _moved(self, event: Slider.Moved) -> None:
        event.stop()
        values = {slider.quantity: slider.value for slider in self.query(Slider)}
        self.post_message(self.Moved(values, overlay=self._overlay))
