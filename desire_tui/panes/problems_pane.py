"""All problems of the open programs, one a row; choosing one goes to it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rich.text import Text
from textual.message import Message
from textual.widgets import OptionList
from textual.widgets.option_list import Option

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from desire_tui.language.problem_marks import Mark


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
        self._listed: tuple[str, list[tuple[int, str, Mark]]] | None = None

    def show(self, programs: Iterable[ProgramProblems]) -> int:
        """List the problems of these programs, as soon as the pane is shown; returns how many there are."""
        self._entries = [(program.tab, program.name, mark) for program in programs for mark in program.marks]
        if all(node.display for node in self.ancestors_with_self):
            self._list()
        return len(self._entries)

    def on_show(self) -> None:
        """List what came while the pane was hidden: each list makes Textual lay the whole screen out."""
        self._list()

    def _list(self) -> None:
        wanted = (self.app.theme, self._entries)
        if wanted == self._listed:
            return
        self._listed = wanted
        theme = self.app.current_theme
        self.clear_options()
        self.add_options(
            Option(
                Text.assemble(
                    f"{name}:{mark.row + 1}:{mark.start + 1} ",
                    (
                        f"{mark.style} {mark.code}: ",
                        str(theme.error if mark.style == "error" else theme.warning),
                    ),
                    mark.message,
                )
            )
            for _, name, mark in self._entries
        )
        if not self._entries:
            self.add_option(Option("No problems.", disabled=True))

    def on_option_list_option_selected(self, event: OptionList.OptionSelected) -> None:
        """Go to the problem."""
        event.stop()
        if self._listed is not None and (entries := self._listed[1]):
            tab, _, mark = entries[event.option_index]
            self.post_message(self.Chosen(tab, mark))
