"""The list from which parameters are chosen that get sliders."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from rich.segment import Segment
from rich.style import Style
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.strip import Strip
from textual.widgets import Input, Label, SelectionList
from textual.widgets.selection_list import Selection

from desire_tui.common.dialogs import Question

if TYPE_CHECKING:
    from collections.abc import Sequence

    from textual.app import ComposeResult

    from desire_tui.engine.session.parameters import Parameter

ROWS_MOST = 500
KINDS = {"number": "", "computed": "computed by the script", "initial": "initial value"}


class Marks(SelectionList[str]):
    """Boxes that are empty or marked: in other colours alone they would look alike on some terminals."""

    def render_line(self, y: int) -> Strip:
        """Draw a row with its own box."""
        line = super().render_line(y)
        row = self.scroll_offset.y + y
        if row >= self.option_count:
            return line
        chosen = self.get_option_at_index(row).value in self.selected
        parts = list(line)
        base = parts[3].style or Style()
        box = [
            Segment(text, base + Style(meta=part.style.meta if part.style else None))
            for text, part in zip("[x]" if chosen else "[ ]", parts[:3], strict=True)
        ]
        return Strip([*box, *parts[3:]], line.cell_length)


class ParameterList(Question["list[Parameter] | None"]):
    """Parameters with their values; Space chooses, Enter gives the chosen ones sliders, Esc: None."""

    DEFAULT_CSS = """
    ParameterList { align: center middle; background: $background 60%; }
    ParameterList > Vertical { width: 58; max-width: 96%; height: auto; max-height: 90%; padding: 0 1;
        background: $panel; border: round $primary; border-title-color: $accent; }
    ParameterList Input { border: none; height: 1; padding: 0 1; background: $surface; }
    ParameterList Input:focus { border: none; }
    ParameterList Marks { height: auto; max-height: 16; border: none; padding: 0;
        background: $panel; }
    ParameterList Marks:focus { border: none; }
    ParameterList Label { width: 1fr; color: $text-muted; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape", "dismiss(None)", "Cancel"),
        Binding("enter", "accept", "Accept", priority=True),
        Binding("slash", "filter", "Filter", show=False),
        Binding("down", "list", "To the list", show=False),
    ]

    def __init__(self, found: Sequence[Parameter], chosen: Sequence[str]) -> None:
        """`chosen`: the labels of those that have a slider."""
        super().__init__()
        self._found = list(found)
        self._chosen = dict.fromkeys(chosen)

    def compose(self) -> ComposeResult:
        """Filter above the list."""
        box = Vertical()
        box.border_title = "Sliders for"
        with box:
            yield Input(placeholder="type to filter · ↓ to the list")
            yield Marks()
            yield Label("Space chooses · Enter shows the sliders · Esc cancels", markup=False)

    def on_mount(self) -> None:
        """Begin in the list."""
        self._fill("")
        self._list.focus()

    @property
    def _list(self) -> Marks:
        return self.query_one(Marks)

    def _fill(self, wanted: str) -> None:
        rows = [one for one in self._found if wanted.casefold() in one.label.casefold()][:ROWS_MOST]
        widest = max((len(one.label) for one in rows), default=4)
        self._list.clear_options()
        self._list.add_options(
            Selection(
                f"{one.label:<{widest}}  {one.value:>12.6g}  {KINDS[one.kind]}".replace("[", r"\["),
                one.label,
                one.label in self._chosen,
            )
            for one in rows
        )
        self._list.highlighted = 0 if rows else None

    def on_input_changed(self, event: Input.Changed) -> None:
        """Show what is looked for."""
        self._note()
        self._fill(event.value)

    def _note(self) -> None:
        """Remember what is chosen among the rows shown."""
        options = (self._list.get_option_at_index(number) for number in range(self._list.option_count))
        shown = [option.value for option in options]
        chosen = set(self._list.selected)
        for label in shown:
            if label in chosen:
                self._chosen[label] = None
            else:
                self._chosen.pop(label, None)

    def action_filter(self) -> None:
        """Move to the filter."""
        self.query_one(Input).focus()

    def action_list(self) -> None:
        """Move to the list."""
        self._list.focus()

    def action_accept(self) -> None:
        """Answer; with nothing chosen, the row under the cursor."""
        self._note()
        if not self._chosen and self._list.highlighted is not None and self._list.option_count:
            self._chosen[self._list.get_option_at_index(self._list.highlighted).value] = None
        self.dismiss([one for one in self._found if one.label in self._chosen])
