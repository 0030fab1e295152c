"""Jump mode: a label on each pane and tab; its letter goes there."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from textual.screen import ModalScreen
from textual.widgets import Label

from desire_tui.editor.tab_strip import TabStrip
from desire_tui.panes.side_pane import SideTabs

if TYPE_CHECKING:
    from collections.abc import Iterator

    from textual import events
    from textual.app import ComposeResult

    from desire_tui.app import DesireApp

TAB_LETTERS = "asdfjklwrtuiovbm"
"""Those of panes are their initials: e c g q p h, n for a new tab."""


class Target(NamedTuple):
    """Where a label stands, its letter, and the action with its argument that goes there."""

    x: int
    y: int
    letter: str
    command_id: str
    argument: str = ""


def targets(app: DesireApp) -> Iterator[Target]:
    """Return what can be jumped to, as it stands on the screen now."""
    screen = app.main_screen
    if "editor" in screen.shown:
        strip = screen.query_one(TabStrip)
        letters = iter(TAB_LETTERS)
        for key, x in strip.places():
            letter = "n" if key < 0 else next(letters, "")
            action = "file.new" if key < 0 else "view.tab"
            if letter:
                yield Target(strip.region.x + x, strip.region.y, letter, action, str(key) if key >= 0 else "")
        text = app.editor.front.content_region
        yield Target(text.x, text.y, "e", "view.editor")
    for name, letter, command_id in (("command", "c", "view.command_line"), ("graph", "g", "view.graph")):
        if name in screen.shown:
            region = screen.query_one(f"#{name}").region
            yield Target(region.x + 1, region.y, letter, command_id)
    if "side" in screen.shown:
        tabs = screen.query_one(SideTabs)
        for name, x in tabs.places():
            yield Target(tabs.region.x + x, tabs.region.y, name[0], "view.side", name)


class JumpScreen(ModalScreen["Target | None"]):
    """Labels over the desktop; dismissed with the target chosen, or None for any other key."""

    DEFAULT_CSS = """
    JumpScreen { background: transparent; layers: labels; }
    JumpScreen Label { layer: labels; position: absolute; width: 3; height: 1; padding: 0 1;
                       background: $accent; color: $background; text-style: bold; }
    """

    def __init__(self, places: list[Target]) -> None:
        super().__init__()
        self._places = places

    def compose(self) -> ComposeResult:
        """Put the labels where they belong."""
        for place in self._places:
            label = Label(place.letter, markup=False)
            label.styles.offset = (place.x, place.y)
            yield label

    def on_key(self, event: events.Key) -> None:
        """Go where the letter says, or nowhere."""
        event.stop()
        self.dismiss(next((p for p in self._places if p.letter == (event.character or "").lower()), None))

    def on_click(self) -> None:
        """Stay."""
        self.dismiss(None)
