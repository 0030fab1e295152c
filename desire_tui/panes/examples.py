"""The examples browser."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

from rich.text import Text
from textual import on
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, Vertical
from textual.screen import ModalScreen
from textual.widgets import Input, OptionList, Static
from textual.widgets.option_list import Option

from desire_tui.places import examples_folder

if TYPE_CHECKING:
    from textual.app import ComposeResult


def first_comment(text: str) -> str:
    """Return what a program says about itself in its first comment line."""
    for line in text.splitlines():
        stripped = line.strip()
        if stripped.startswith("--") and stripped.strip("- =*"):
            return stripped.lstrip("- ").strip()
        if stripped and not stripped.startswith("--"):
            break
    return ""


class ExamplesScreen(ModalScreen[Path | None]):
    """Programs by chapter, with a filter; the chosen one is shown beside. Dismissed with a path or None."""

    DEFAULT_CSS = """
    ExamplesScreen { align: center middle; background: $background 60%; }
    ExamplesScreen > Vertical { width: 92%; height: 86%; background: $surface; border: round $primary;
                                border-title-color: $accent; }
    ExamplesScreen Input { height: 1; border: none; padding: 0 1; background: $panel; }
    ExamplesScreen Input:focus { border: none; }
    ExamplesScreen OptionList { width: 2fr; border: none; padding: 0; background: $surface; height: 1fr;
                                text-wrap: nowrap; text-overflow: ellipsis; overflow-x: hidden; }
    ExamplesScreen Static { width: 3fr; padding: 0 1; height: 1fr; border-left: solid $panel; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape", "dismiss(None)", "Close"),
        Binding("down", "move(1)", show=False),
        Binding("up", "move(-1)", show=False),
        Binding("pagedown", "move(10)", show=False),
        Binding("pageup", "move(-10)", show=False),
    ]

    def __init__(self) -> None:
        super().__init__()
        self._folder = examples_folder()
        self._programs = sorted(self._folder.rglob("*.src"))
        self._texts = {path: path.read_text(encoding="utf-8", errors="replace") for path in self._programs}
        self._listed: list[Path] = []

    def compose(self) -> ComposeResult:
        """Filter, list, preview."""
        box = Vertical()
        box.border_title = "Examples"
        with box:
            yield Input(placeholder="filter · ↑↓ choose · Enter opens · Esc", id="examples-filter")
            with Horizontal():
                yield OptionList()
                yield Static(markup=False)

    def on_mount(self) -> None:
        """Show all."""
        self._list("")
        self.query_one(OptionList).can_focus = False

    def _list(self, wanted: str) -> None:
        words = wanted.casefold().split()
        options = self.query_one(OptionList)
        options.clear_options()
        self._listed = []
        for path in self._programs:
            name, about = (
                str(path.relative_to(self._folder).with_suffix("")),
                first_comment(self._texts[path]),
            )
            if all(word in f"{name} {about}".casefold() for word in words):
                self._listed.append(path)
                options.add_option(
                    Option(Text.assemble((name, "bold"), "\n  ", (about, "dim"), no_wrap=True))
                )
        if self._listed:
            options.highlighted = 0
        else:
            options.add_option(
                Option(
                    "No such example." if self._programs else f"No examples in {self._folder}", disabled=True
                )
            )
            self.query_one(Static).update("")

    @on(Input.Changed)
    def _filter(self, event: Input.Changed) -> None:
        self._list(event.value)

    @on(OptionList.OptionHighlighted)
    def _preview(self, event: OptionList.OptionHighlighted) -> None:
        if 0 <= event.option_index < len(self._listed):
            self.query_one(Static).update(Text(self._texts[self._listed[event.option_index]], no_wrap=True))

    @on(OptionList.OptionSelected)
    def _clicked(self, event: OptionList.OptionSelected) -> None:
        self.dismiss(self._listed[event.option_index])

    @on(Input.Submitted)
    def _open(self) -> None:
        at = self.query_one(OptionList).highlighted
        if self._listed and at is not None:
            self.dismiss(self._listed[at])

    def action_move(self, step: int) -> None:
        """Move through the list while the filter keeps the keys."""
        options = self.query_one(OptionList)
        if self._listed:
            options.highlighted = min(max((options.highlighted or 0) + step, 0), len(self._listed) - 1)
