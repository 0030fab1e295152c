"""Opens the completion list for the editor and the command line, and puts the chosen word in.

The list never changes what somebody types who does not look at it. It opens when typing rests. Enter takes
a word only after the arrows chose one (or the list was asked for), Tab only once the list has been on the
screen long enough to be seen, and it takes nothing for a word that is complete.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.geometry import Offset

from desire_tui.commands import COMMAND_LINE_WORDS
from desire_tui.editor.code_area import CodeArea
from desire_tui.editor.completion_popup import CompletionPopup
from desire_tui.language.completion import OFFERED_MAX, around, is_complete, offers
from desire_tui.language.file_columns import file_columns
from desire_tui.language.line_tokens import word_before
from desire_tui.panes.prompt import Prompt

if TYPE_CHECKING:
    from collections.abc import Callable

    from textual import events
    from textual.timer import Timer

    from desire_tui.common.config import Config
    from desire_tui.engine.values import Values

OPEN_AFTER_S = 0.08
"""The list opens by itself when nothing was typed for so long."""
SEEN_AFTER_S = 0.15
"""A Tab or arrow that comes sooner after the list was drawn was not meant for it."""
Target = CodeArea | Prompt


class Completer:
    """Works for whichever of the two has the focus."""

    def __init__(self, settings: Config, front: Callable[[], CodeArea], values: Callable[[], Values]) -> None:
        self._settings = settings
        self._front = front
        """The editor's text, whose names are offered in the command line too."""
        self._values = values
        self.popup = CompletionPopup()
        self._target: Target | None = None
        self._start = (0, 0)
        """Where the word begins that the list completes."""
        self._is_cut = False
        self._by_hand = False
        self._complete = False
        self._timer: Timer | None = None
        self.seen_after_s = SEEN_AFTER_S

    # ---------------------------------------------------------------------------------- what a target reports

    def letter_typed(self, target: Target) -> None:
        """Follow a letter: narrow the list that is open, offer one when typing rests."""
        self._by_hand = False
        if self.popup.is_open:
            self._narrow(target)
        if isinstance(target, CodeArea) and self._settings.completion_after:
            self._stop_timer()
            self._timer = target.set_timer(OPEN_AFTER_S, lambda: self._offer(target))

    def text_changed(self, target: Target) -> None:
        """Follow a change of text or cursor that no letter made: a list that no longer fits goes away."""
        if self.popup.is_open and not self._fits(target):
            self._narrow(target)

    def focus_lost(self, target: Target) -> None:
        """Close what a target had open: it lost the focus."""
        if target is self._target:
            self.close()

    def handle_key(self, event: events.Key, target: Target) -> bool:
        """Use up a key that is meant for the open list; False if it is the target's own."""
        if not self.popup.is_open:
            if event.key in {"enter", "tab", "escape"}:
                self._stop_timer()
            return False
        if event.key == "escape":
            self.close()
            return True
        if event.key not in {"up", "down", "pageup", "pagedown", "enter", "tab"}:
            return False
        meant = self._by_hand or event.time >= self.popup.seen_at + self.seen_after_s
        if event.key == "enter":
            meant = self._by_hand
        elif event.key == "tab":
            meant = meant and (self._by_hand or not self._complete)
        if not meant or not self._fits(target):
            self.close()
            return False
        if event.key in {"enter", "tab"}:
            self.insert_chosen()
        else:
            self.popup.move(event.key)
            self._by_hand = True
        return True

    # ---------------------------------------------------------------------------------- opening and closing

    def offer(self, target: Target) -> None:
        """Offer completions at the cursor on demand; a single one is put in at once."""
        if _is_prose(target):
            return
        if self._show(target) == 1:
            self.insert_chosen()
        self._by_hand = self.popup.is_open

    def _offer(self, target: Target) -> None:
        """Offer completions by itself, if enough letters stand before the cursor and none behind."""
        if not target.has_focus or _is_prose(target) or self._is_up_to_date(target):
            return
        line, column = _here(target)
        in_a_word = line[column : column + 1].isalnum()
        if in_a_word or len(word_before(line, column)) < self._settings.completion_after:
            self.close()
            return
        self._by_hand = False
        self._show(target)

    def _is_up_to_date(self, target: Target) -> bool:
        return self.popup.is_open and self._fits(target) and not self._is_cut

    def _show(self, target: Target) -> int:
        """Open the list; returns how many words it offers."""
        line, column = _here(target)
        prefix = word_before(line, column)
        command = isinstance(target, Prompt)
        area = self._front() if command else target
        assert isinstance(area, CodeArea)
        lines = around(area.document.lines, area.cursor_location[0])
        known = {**file_columns(lines, area.buffer.path), **self._known()}
        typed_itself, words = (0, COMMAND_LINE_WORDS) if command else (1, ())
        self._complete = is_complete(prefix, lines, known, commands=words, itself=typed_itself)
        found = offers(prefix, lines, known, commands=words, complete=self._complete)
        if len(found) == 1 and self._complete:
            found = []
        self._target, self._start, self._is_cut = target, _word_start(target), len(found) == OFFERED_MAX
        self.popup.show(found, prefix, Offset(*target.cursor_screen_offset), above=command)
        return len(found)

    def _narrow(self, target: Target) -> None:
        """Leave the words in the open list that still fit; close it if none does."""
        prefix = word_before(*_here(target))
        same_word = target is self._target and _word_start(target) == self._start
        if not same_word or not prefix.startswith(self.popup.prefix) or not self.popup.prefix:
            self.close()
            return
        left = [offer for offer in self.popup.offered if offer.word.casefold().startswith(prefix.casefold())]
        self._complete = any(offer.word == prefix for offer in left)
        if all(offer.word == prefix for offer in left):
            self.close()
            return
        left.sort(key=lambda offer: offer.word != prefix)
        self.popup.show(left, prefix, Offset(*target.cursor_screen_offset), above=isinstance(target, Prompt))

    def _fits(self, target: Target) -> bool:
        """Whether the list was made for what stands before the cursor now."""
        return (
            target is self._target
            and word_before(*_here(target)) == self.popup.prefix
            and _word_start(target) == self._start
        )

    def _known(self) -> dict[str, str]:
        values = self._values()
        return {
            q.name: f"= {values.cells[q.slot]:g}" if not q.shape else f"ARRAY[{','.join(map(str, q.shape))}]"
            for q in values
            if values.is_defined(q)
        }

    def close(self) -> None:
        """Hide the list."""
        self._stop_timer()
        self._by_hand = False
        if self.popup.is_open:
            self.popup.close()

    def _stop_timer(self) -> None:
        if self._timer is not None:
            self._timer.stop()
            self._timer = None

    def insert_chosen(self) -> None:
        """Put the chosen word in the place of the letters typed."""
        offer, target, prefix = self.popup.chosen, self._target, self.popup.prefix
        fits = target is not None and self._fits(target)
        self.close()
        if offer is None or not fits:
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


def _is_prose(target: Target) -> bool:
    """Whether the text is no program: its words are none of the language's."""
    return isinstance(target, CodeArea) and not target.buffer.is_program


def _here(target: Target) -> tuple[str, int]:
    """Return the line the cursor is in, and the cursor's column."""
    if isinstance(target, Prompt):
        return target.value, target.cursor_position
    row, column = target.cursor_location
    line = target.document.get_line(row)
    begun = row > 0 and line[:1].isalnum() and target.document.get_line(row - 1).rstrip().endswith("_")
    return ("", 0) if begun and line[:column].isalnum() else (line, column)  # a word of two rows: no offers


def _word_start(target: Target) -> tuple[int, int]:
    line, column = _here(target)
    row = target.cursor_location[0] if isinstance(target, CodeArea) else 0
    return row, column - len(word_before(line, column))
