"""Questions to the user: a choice, a line of text. Esc always means no."""

from __future__ import annotations

from time import monotonic
from typing import TYPE_CHECKING, ClassVar, TypeVar

from textual.await_complete import AwaitComplete
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, Vertical
from textual.screen import ModalScreen
from textual.widgets import Button, Input, Label

if TYPE_CHECKING:
    from collections.abc import Sequence

    from textual import events
    from textual.app import ComposeResult

Answer = TypeVar("Answer")
GRACE_SECONDS = 0.8
"""A question that comes up by itself takes no answer for so long.

What is then typed was meant for something else.
"""
_CSS = """
    align: center middle;
    background: $background 60%;
"""
_BOX = """
    width: 62; max-width: 96%; height: auto; max-height: 90%; padding: 1 2; background: $panel;
    border: round $primary; border-title-color: $accent;
"""


class Question(ModalScreen[Answer]):
    """Anything that is answered once: keys typed before it is gone are not a second answer."""

    answered = False

    def dismiss(self, result: Answer | None = None) -> AwaitComplete:
        """Answer, the first time."""
        if self.answered:
            return AwaitComplete()
        self.answered = True
        return super().dismiss(result)


class Choice(Question["str | None"]):
    """A sentence and buttons; each answers to its first letter, too.

    Dismissed with the button's word, Esc: None. `unasked`: it comes up while the user does something else.
    """

    DEFAULT_CSS = f"""
    Choice {{ {_CSS} }}
    Choice > Vertical {{ {_BOX} }}
    Choice Label {{ width: 1fr; height: auto; margin-bottom: 1; }}
    Choice Horizontal {{ height: auto; align-horizontal: right; }}
    Choice Button {{ margin-left: 1; min-width: 10; background: $surface; }}
    Choice Button:focus {{ background: $primary !important; color: $background !important;
                          text-style: bold !important; }}
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape", "cancel", "Cancel"),
        Binding("left", "app.focus_previous", show=False),
        Binding("right", "app.focus_next", show=False),
    ]

    def __init__(self, title: str, sentence: str, choices: Sequence[str], *, unasked: bool = False) -> None:
        super().__init__()
        self._title, self._sentence, self._choices = title, sentence, choices
        self._since = monotonic() if unasked else float("-inf")

    def compose(self) -> ComposeResult:
        """Put the sentence above its answers."""
        box = Vertical()
        box.border_title = self._title
        with box:
            yield Label(self._sentence, markup=False)
            with Horizontal():
                for number, choice in enumerate(self._choices):
                    yield Button(choice, id=f"choice-{number}", compact=True)

    def _answer(self, choice: str | None) -> None:
        if monotonic() - self._since >= GRACE_SECONDS:
            self.dismiss(choice)

    def action_cancel(self) -> None:
        """Answer no."""
        self._answer(None)

    def on_button_pressed(self, event: Button.Pressed) -> None:
        """Answer."""
        self._answer(self._choices[int((event.button.id or "-0").rpartition("-")[2])])

    def on_key(self, event: events.Key) -> None:
        """Answer by first letter."""
        for choice in self._choices:
            if event.character and choice[0].lower() == event.character.lower():
                event.stop()
                self._answer(choice)
                return


class LineDialog(Question[str]):
    """Asks for a line of text; Esc gives an empty one."""

    DEFAULT_CSS = f"""
    LineDialog {{ {_CSS} }}
    LineDialog > Vertical {{ {_BOX} }}
    LineDialog Input {{ border: none; height: 1; padding: 0 1; background: $surface; }}
    LineDialog Input:focus {{ border: none; }}
    LineDialog Label {{ width: 1fr; color: $text-muted; margin-top: 1; }}
    """
    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape", "dismiss('')", "Cancel")]

    def __init__(self, title: str, value: str = "", hint: str = "") -> None:
        super().__init__()
        self._title, self._value, self._hint = title, value, hint

    def compose(self) -> ComposeResult:
        """One field and a hint."""
        box = Vertical()
        box.border_title = self._title
        with box:
            yield Input(self._value, select_on_focus=True)
            if self._hint:
                yield Label(self._hint, markup=False)

    def on_input_submitted(self, event: Input.Submitted) -> None:
        """Answer."""
        self.dismiss(event.value)
