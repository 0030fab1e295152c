"""The list of completions that opens at the cursor."""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING

from rich.text import Text
from textual.widgets import OptionList
from textual.widgets.option_list import Option

if TYPE_CHECKING:
    from collections.abc import Sequence

    from textual.geometry import Offset

    from desire_tui.language.completion import Offer

ROWS_MAX = 8
WORD_WIDTH = 14


class CompletionPopup(OptionList):
    """Words to choose from; keys come from the widget that has the focus, which keeps it."""

    DEFAULT_CSS = """
    CompletionPopup { layer: popup; position: absolute; display: none; height: auto; max-height: 8;
            padding: 0;
                      border: none; background: $panel; color: $foreground; scrollbar-size-vertical: 1;
                      text-wrap: nowrap; text-overflow: ellipsis; }
    CompletionPopup > .option-list--option { padding: 0 1; }
    CompletionPopup > .option-list--option-highlighted { background: $primary; color: $background;
            text-style: bold; }
    """
    can_focus = False

    def __init__(self) -> None:
        super().__init__(id="completion")
        self.offered: list[Offer] = []
        self.prefix = ""
        self.seen_at = math.inf
        """When the list was drawn, on the clock of `Message.time`; infinite before."""

    @property
    def is_open(self) -> bool:
        """Whether the list is shown."""
        return bool(self.display)

    @property
    def chosen(self) -> Offer | None:
        """The word marked at the moment."""
        return self.offered[self.highlighted] if self.is_open and self.highlighted is not None else None

    def show(self, found: Sequence[Offer], prefix: str, at: Offset, *, above: bool = False) -> None:
        """Open the list below (or above) a screen cell; closes it if there is nothing to offer."""
        self.offered, self.prefix = list(found), prefix
        if not found:
            self.close()
            return
        screen = self.app.size
        longest = max(len(o.about) for o in found)
        word_width = max(WORD_WIDTH, *(len(o.word) + 1 for o in found))
        width = min(word_width + longest + 3, screen.width - 2, 72)
        self.clear_options()
        self.add_options(
            Option(Text.assemble((f"{o.word:<{word_width}}", "bold"), f"{o.about}", no_wrap=True))
            for o in found
        )
        rows = min(len(found), ROWS_MAX)
        below = at.y + 1
        y = at.y - rows if above or below + rows > screen.height else below
        x = max(0, min(at.x - len(prefix) - 1, screen.width - width))
        self.styles.width = width
        self.styles.offset = (x, max(0, y))
        self.highlighted = 0
        if not self.is_open:
            self.display = True
            self.call_after_refresh(self._drawn)

    def _drawn(self) -> None:
        self.seen_at = time.monotonic()

    def close(self) -> None:
        """Hide the list."""
        self.display = False
        self.seen_at = math.inf

    def move(self, key: str) -> None:
        """Move the mark as an arrow or page key asks."""
        match key:
            case "up":
                self.action_cursor_up()
            case "down":
                self.action_cursor_down()
            case "pageup":
                self.action_page_up()  # type: ignore[no-untyped-call]
            case "pagedown":
                self.action_page_down()  # type: ignore[no-untyped-call]
