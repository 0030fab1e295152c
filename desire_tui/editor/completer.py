"""Opens the completion list for the editor and the command line, and puts the chosen word in."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.geometry import Offset

from desire_tui.editor.area import CodeArea
from desire_tui.editor.completion import offers, prefix_of
from desire_tui.panes.prompt import Prompt

if TYPE_CHECKING:
    from desire_tui.app import DesireApp
    from desire_tui.editor.popup import CompletionPopup


class Completer:
    """Works for whichever of the two has the focus."""

    def __init__(self, app: DesireApp, popup: CompletionPopup) -> None:
        self._app = app
        self._popup = popup

    def open(self, *, forced: bool) -> None:
        """Offer completions at the cursor: on demand (`forced`), or once enough letters stand there."""
        target = self._app.focused
        if isinstance(target, CodeArea):
            row, column = target.cursor_location
            prefix = prefix_of(target.document.get_line(row), column)
            texts, at = [target.text], target.cursor_screen_offset
        elif isinstance(target, Prompt):
            column = target.cursor_position
            prefix = prefix_of(target.value, column)
            texts, at = [self._app.editor.front.text], target.cursor_screen_offset
        else:
            return
        enough = self._app.settings.completion_after
        if not forced and (not enough or len(prefix) < enough):
            self.close()
            return
        line_end = len(target.document.get_line(row)) if isinstance(target, CodeArea) else len(target.value)
        if not forced and column < line_end and self._next_is_letter(target, column):
            self.close()
            return
        found = offers(prefix, texts, self._known(), commands=isinstance(target, Prompt))
        self._popup.show(found, prefix, Offset(*at), above=isinstance(target, Prompt))
        if forced and len(found) == 1:
            self.take()
            return
        if isinstance(target, CodeArea | Prompt):
            target.popup_open = self._popup.is_open

    @staticmethod
    def _next_is_letter(target: CodeArea | Prompt, column: int) -> bool:
        line = (
            target.document.get_line(target.cursor_location[0])
            if isinstance(target, CodeArea)
            else target.value
        )
        return line[column : column + 1].isalnum()

    def _known(self) -> dict[str, str]:
        values = self._app.session.values
        return {
            q.name: f"= {values.cells[q.slot]:g}" if not q.shape else f"ARRAY[{','.join(map(str, q.shape))}]"
            for q in values
            if values.is_defined(q)
        }

    def close(self) -> None:
        """Hide the list."""
        self._popup.close()
        self._app.command.prompt.popup_open = False
        for area in self._app.editor.areas:
            area.popup_open = False

    def key(self, key: str) -> None:
        """Carry out a key of the open list."""
        if key == "escape":
            self.close()
        elif key in {"tab", "enter"}:
            self.take()
        else:
            self._popup.move(key)

    def take(self) -> None:
        """Put the chosen word in the place of the letters typed."""
        offer, target = self._popup.chosen, self._app.focused
        prefix = self._popup.prefix
        self.close()
        if offer is None:
            return
        if isinstance(target, CodeArea):
            row, column = target.cursor_location
            target.replace(
                offer.word, (row, column - len(prefix)), (row, column), maintain_selection_offset=False
            )
            target.move_cursor((row, column - len(prefix) + len(offer.word)))
        elif isinstance(target, Prompt):
            at = target.cursor_position
            target.value = target.value[: at - len(prefix)] + offer.word + target.value[at:]
            target.cursor_position = at - len(prefix) + len(offer.word)
