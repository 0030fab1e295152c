"""Questions to the user: a choice, a line of text. Esc always means no."""

from __future__ import annotations

from math import inf
from time import monotonic
from typing import TYPE_CHECKING, ClassVar, TypeVar

from textual.await_complete import AwaitComplete
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, Vertical, VerticalScroll
from textual.screen import ModalScreen
from textual.widgets import Button, Input, Label

if TYPE_CHECKING:
    from collections.abc import Sequence

    from textual import events
    from textual.app import ComposeResult

Answer = TypeVar("Answer")
GRACE_SECONDS = 0.8
"""A question that comes up by itself takes no answer for so long.

What is then typed was meant for something else; it waits on until nothing more is typed.
"""
UNREAD = "↓ PgDn to the end"
LOW_BELOW = 14
"""On fewer rows the box has no blank ones."""
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
    """A text and buttons; each answers to its first letter, too. The text scrolls, the buttons stay.

    Dismissed with the button's word, Esc: None. `unasked`: it comes up while the user does something else.
    `safe`: the answer that grants nothing. It has the focus at first; the others are not taken before the
    text was seen to its end, and no key counts that was typed before the question was drawn.
    """

    DEFAULT_CSS = f"""
    Choice {{ {_CSS} }}
    Choice > Vertical {{ {_BOX} max-height: 100%; }}
    Choice VerticalScroll {{ height: auto; margin-bottom: 1; scrollbar-size-vertical: 1; }}
    Choice Label {{ width: 1fr; height: auto; }}
    Choice Horizontal {{ height: auto; align-horizontal: right; }}
    Choice Button {{ margin-left: 1; min-width: 10; background: $surface; }}
    Choice.-low > Vertical {{ padding: 0 1; }}
    Choice.-low VerticalScroll {{ margin-bottom: 0; }}
    Choice Button:focus {{ background: $primary !important; color: $background !important;
                          text-style: bold !important; }}
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape", "cancel", "Cancel"),
        Binding("left", "app.focus_previous", show=False),
        Binding("right", "app.focus_next", show=False),
        Binding("up", "read(-1)", show=False),
        Binding("down", "read(1)", show=False),
        Binding("pageup", "read(-1, True)", show=False),
        Binding("pagedown", "read(1, True)", show=False),
    ]

    def __init__(
        self,
        title: str,
        sentence: str,
        choices: Sequence[str],
        *,
        unasked: bool = False,
        safe: str | None = None,
    ) -> None:
        super().__init__()
        self._title, self._sentence, self._choices = title, sentence, choices
        self._unasked, self._safe = unasked, safe
        self._drawn_at = inf
        self._quiet_since = inf
        self._is_read = False

    def compose(self) -> ComposeResult:
        """Put the text above its answers."""
        box = Vertical()
        box.border_title, box.border_subtitle = self._title, UNREAD
        with box:
            with VerticalScroll(can_focus=False):
                yield Label(self._sentence, markup=False)
            with Horizontal():
                for number, choice in enumerate(self._choices):
                    yield Button(choice, id=f"choice-{number}", compact=True)

    def on_mount(self) -> None:
        """Begin with the answer that grants nothing."""
        if self._safe is not None:
            self.query_one(f"#choice-{self._choices.index(self._safe)}").focus()
        self._fit()
        self.call_after_refresh(self._drawn)
        self.watch(self.query_one(VerticalScroll), "scroll_y", self._note_reading, init=False)

    def on_resize(self) -> None:
        """Leave room for the buttons."""
        self._fit()
        self.call_after_refresh(self._note_reading)

    def _fit(self) -> None:
        height = self.app.size.height
        low = height < LOW_BELOW
        self.set_class(low, "-low")
        self.query_one(VerticalScroll).styles.max_height = max(height - (3 if low else 6), 1)

    def _drawn(self) -> None:
        self._drawn_at = self._quiet_since = monotonic()
        self._note_reading()

    def _note_reading(self) -> None:
        text = self.query_one(VerticalScroll)
        if self._drawn_at < inf and text.size and text.scroll_offset.y >= text.max_scroll_y:
            self._is_read = True
            self.query_one(Vertical).border_subtitle = ""

    def takes(self, event: events.Key) -> bool:
        """Whether a key can be meant for this question: not if it was typed before it."""
        if self._safe is None and not self._unasked:
            return True
        if event.time < self._drawn_at:
            return False
        if self._is_too_early():
            self._quiet_since = monotonic()
            return False
        return True

    def _is_too_early(self) -> bool:
        return self._unasked and monotonic() - self._quiet_since < GRACE_SECONDS

    def _answer(self, choice: str | None) -> None:
        if self._is_too_early():
            return
        if self._safe is None or self._is_read or choice in (None, self._safe):
            self.dismiss(choice)

    def action_cancel(self) -> None:
        """Answer no."""
        self._answer(None)

    def action_read(self, step: int, page: bool = False) -> None:
        """Scroll the text by a row or a page."""
        text = self.query_one(VerticalScroll)
        rows = max(text.size.height - 1, 1) if page else 1
        text.scroll_to(y=text.scroll_offset.y + step * rows, animate=False, immediate=True)

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
