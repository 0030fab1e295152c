"""The commands of this and former sessions, newest first; one is chosen for the command line."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from rich.text import Text
from textual import on
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.widgets import Input, Label, OptionList
from textual.widgets.option_list import Option

from desire_tui.common.dialogs import Question
from desire_tui.engine.visible_text import visible_line

if TYPE_CHECKING:
    from collections.abc import Sequence

    from textual.app import ComposeResult

ROWS_MOST = 300
"""Of more lines the search finds the others."""


class HistoryList(Question[str]):
    """Dismissed with the line that was chosen, Esc: an empty text."""

    DEFAULT_CSS = """
    HistoryList { align: center middle; background: $background 60%; }
    HistoryList > Vertical { width: 90; max-width: 96%; height: 80%; padding: 0 1;
        background: $panel; border: round $primary; border-title-color: $accent; }
    HistoryList Input { border: none; height: 1; padding: 0 1; background: $surface; }
    HistoryList Input:focus { border: none; }
    HistoryList OptionList { height: 1fr; border: none; padding: 0; background: $panel; text-wrap: nowrap;
        text-overflow: ellipsis; scrollbar-size-vertical: 1; }
    HistoryList OptionList:focus { border: none; }
    HistoryList Label { width: 1fr; color: $text-muted; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape", "dismiss('')", "Cancel"),
        Binding("down", "move('down')", show=False),
        Binding("up", "move('up')", show=False),
        Binding("pagedown", "move('page_down')", show=False),
        Binding("pageup", "move('page_up')", show=False),
    ]

    def __init__(self, lines: Sequence[str]) -> None:
        """`lines`: oldest first."""
        super().__init__()
        self._lines = lines[::-1]
        self._found: list[str] = []

    def compose(self) -> ComposeResult:
        """Put a field above the list."""
        box = Vertical()
        box.border_title = "Former commands"
        with box:
            yield Input(placeholder="type a part of the line")
            lines = OptionList()
            lines.can_focus = False  # the cursor stays in the field
            yield lines
            yield Label("Enter takes the line to the command line · Esc closes", markup=False)

    def on_mount(self) -> None:
        """Show all."""
        self._fill("")

    @property
    def _list(self) -> OptionList:
        return self.query_one(OptionList)

    def _fill(self, part: str) -> None:
        wanted = part.casefold().split()
        found = (line for line in self._lines if all(word in line.casefold() for word in wanted))
        self._found = [line for line, _ in zip(found, range(ROWS_MOST), strict=False)]
        self._list.clear_options()
        self._list.add_options(Option(Text(visible_line(line))) for line in self._found)
        self._list.highlighted = 0 if self._found else None

    @on(Input.Changed)
    def _search(self, event: Input.Changed) -> None:
        event.stop()
        self._fill(event.value)

    def action_move(self, move: str) -> None:
        """Choose in the list."""
        getattr(self._list, f"action_{'cursor_' if move in ('up', 'down') else ''}{move}")()

    @on(Input.Submitted)
    def _take(self, event: Input.Submitted) -> None:
        event.stop()
        if self._list.highlighted is not None and self._found:
            self.dismiss(self._found[self._list.highlighted])

    @on(OptionList.OptionSelected)
    def _clicked(self, event: OptionList.OptionSelected) -> None:
        event.stop()
        self.dismiss(self._found[event.option_index])
