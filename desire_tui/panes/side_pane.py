"""The side pane: quantities, problems and help share one place; a row of tabs says which there are."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from rich.segment import Segment
from rich.style import Style
from textual import on
from textual.containers import Vertical
from textual.message import Message
from textual.reactive import reactive
from textual.widgets import ContentSwitcher

from desire_tui.common.frame_top import FrameTop
from desire_tui.panes.help_pane import HelpPane
from desire_tui.panes.problems_pane import ProblemsPane
from desire_tui.panes.quantities_pane import QuantitiesPane

if TYPE_CHECKING:
    from collections.abc import Mapping

    from textual import events
    from textual.app import ComposeResult
    from textual.strip import Strip

Side = Literal["quantities", "problems", "help"]
NAMES: tuple[Side, ...] = ("quantities", "problems", "help")


class SideTabs(FrameTop):
    """One row instead of a border: `─ Quantities │ Problems 2 │ Help ─────`. A click chooses."""

    DEFAULT_CSS = """
    SideTabs { height: 1; width: 1fr; color: $frame; }
    """
    current: reactive[Side] = reactive[Side]("quantities")
    problems: reactive[int] = reactive(0)
    """How many problems there are."""

    class Chosen(Message):
        """A tab was clicked."""

        def __init__(self, name: Side) -> None:
            super().__init__()
            self.name = name

    def _pieces(self) -> list[tuple[Side, str]]:
        count = f" {self.problems}" if self.problems else ""
        return [(name, f" {name.capitalize()}{count if name == 'problems' else ''} ") for name in NAMES]

    def render_line(self, y: int) -> Strip:
        """Draw the row."""
        del y
        line = self.line
        theme = self.app.current_theme
        chosen = line + Style(color=str(theme.accent), bold=True)
        other = line + Style(color=str(theme.foreground))
        segments: list[Segment] = []
        for name, text in self._pieces():
            if segments:
                segments.append(Segment("│", line))
            style = chosen if name == self.current else other
            if name == "problems" and self.problems:
                style += Style(color=str(theme.error))
            segments.append(Segment(text, style))
        return self.row(segments)

    def on_click(self, event: events.Click) -> None:
        """Choose the tab under the mouse."""
        for name, left in self.places():
            if left <= event.x < left + len(dict(self._pieces())[name]):
                self.post_message(self.Chosen(name))

    def places(self) -> list[tuple[Side, int]]:
        """Return the tabs with the column of each."""
        places, at = [], self.begins
        for name, text in self._pieces():
            places.append((name, at))
            at += len(text) + 1
        return places


class SidePane(Vertical):
    """The tabs, and the page that is chosen."""

    DEFAULT_CSS = """
    SidePane { background: $surface; }
    SidePane ContentSwitcher { height: 1fr; }
    """

    class PageRequested(Message):
        """A page was chosen with the mouse: show it and move there."""

        def __init__(self, name: Side) -> None:
            super().__init__()
            self.name = name

    def __init__(self, keys: Mapping[str, str]) -> None:
        """`keys`: those of each command id that the user configured."""
        super().__init__(id="side")
        self.quantities = QuantitiesPane()
        self.problems = ProblemsPane()
        self.help = HelpPane(keys)

    def compose(self) -> ComposeResult:
        """Tabs above the pages."""
        yield SideTabs()
        with ContentSwitcher(id="side-body", initial="quantities"):
            yield self.quantities
            yield self.problems
            yield self.help

    @property
    def current(self) -> Side:
        """The page that is chosen."""
        return self.query_one(SideTabs).current

    def choose(self, name: Side) -> None:
        """Show a page."""
        self.query_one(SideTabs).current = name
        self.query_one(ContentSwitcher).current = name

    def count_problems(self, count: int) -> None:
        """Show in the tabs how many problems there are."""
        self.query_one(SideTabs).problems = count

    @on(SideTabs.Chosen)
    def _chosen(self, event: SideTabs.Chosen) -> None:
        event.stop()
        self.post_message(self.PageRequested(event.name))
