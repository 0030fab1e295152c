"""All problems of the open programs, one a row; choosing one goes to it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rich.text import Text
from textual.message import Message
from textual.widgets import OptionList
from textual.widgets.option_list import Option

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from desire_tui.common.problem_marks import Mark


class ProgramProblems(NamedTuple):
    """A tab's problems."""

    tab: int
    """Number of the tab."""
    name: str
    marks: Sequence[Mark]
    """In the order of the text."""


class ProblemsPane(OptionList):
    """A list of problems."""

    DEFAULT_CSS = """
    ProblemsPane { border: none; padding: 0; background: $surface; scrollbar-size-vertical: 1; }
    ProblemsPane:focus { border: none; }
    """

    class Chosen(Message):
        """Go to this problem."""

        def __init__(self, tab: int, mark: Mark) -> None:
            super().__init__()
            self.tab = tab
            self.mark = mark

    def __init__(self) -> None:
        super().__init__(id="problems")
        self._entries: list[tuple[int, str, Mark]] = []
        self._theme = ""

    def show(self, programs: Iterable[ProgramProblems]) -> int:
        """List the problems of these programs; returns how many there are."""
        entries = [(program.tab, program.name, mark) for program in programs for mark in program.marks]
        if entries == self._entries and self.option_count and self._theme == self.app.theme:
            return len(entries)
        self._theme = self.app.theme
        self._entries = entries
        theme = self.app.current_theme
        self.clear_options()
        for _, name, mark in entries:
            colour = str(theme.error if mark.style == "error" else theme.warning)
            place = f"{name}:{mark.row + 1}:{mark.start + 1} "
            self.add_option(
                Option(Text.assemble(place, (f"{mark.style} {mark.code}: ", colour), mark.message))
            )
        if not entries:
            self.add_option(Option("No problems.", disabled=True))
        return len(entries)

    def on_option_list_option_selected(self, event: OptionList.OptionSelected) -> None:
        """Go to the problem."""
        event.stop()
        if self._entries:
            tab, _, mark = self._entries[event.option_index]
            self.post_message(self.Chosen(tab, mark))
