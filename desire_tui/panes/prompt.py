"""The line where commands are typed."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from rich.cells import cell_len
from textual.binding import Binding, BindingType
from textual.expand_tabs import expand_tabs_inline
from textual.message import Message
from textual.widgets import Input

from desire_tui.engine.visible_text import visible

if TYPE_CHECKING:
    from collections.abc import Callable

    from textual import events

    from desire_tui.common.completion_hook import CompletionHook
    from desire_tui.panes.command_history import CommandHistory
    from desire_tui.panes.pending_lines import PendingLines


class Prompt(Input):
    """Arrow keys walk through the lines that begin as what was typed, Ctrl+R searches, Tab completes."""

    DEFAULT_CSS = """
    Prompt { border: none; height: 1; padding: 0; width: 1fr; background: $surface; }
    Prompt:focus { border: none; background: $surface; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("up", "older", "Older", show=False),
        Binding("down", "newer", "Newer", show=False),
        Binding("escape", "clear", "Clear", show=False),
    ]

    class Searching(Message):
        """The history search began, went on, or ended (`pattern` None)."""

        def __init__(self, pattern: str | None) -> None:
            super().__init__()
            self.pattern = pattern

    def __init__(
        self,
        history: CommandHistory,
        pending: PendingLines,
        completion: CompletionHook,
        entered: Callable[[list[str]], object],
    ) -> None:
        """`entered` is called with a line, or with several pasted ones."""
        super().__init__(id="prompt", select_on_focus=False)
        self.history = history
        self.pending = pending
        self._entered = entered
        self.completion = completion
        self._pattern: str | None = None
        self._hit: int | None = None

    # --------------------------------------------------------------------------------------------- history

    def action_older(self) -> None:
        """Show the line before: of those held back, else of the history."""
        self._show(
            self.history.previous(self.value) if self.pending.is_empty else self.pending.step(-1, self.value)
        )

    def action_newer(self) -> None:
        """Show the line after."""
        self._show(self.history.next() if self.pending.is_empty else self.pending.step(1, self.value))

    def action_clear(self) -> None:
        """Empty the line; lines held back are given up."""
        self.pending.take()
        self.value = ""
        self.history.forget_place()

    def _show(self, line: str | None) -> None:
        if line is not None:
            self.value = line
            self.cursor_position = len(line)

    def search(self) -> None:
        """Begin to search the history, or go to the hit before."""
        if self._pattern is None:
            self._pattern, self._hit = self.value, None
        else:
            self._find(older_than=self._hit)
        self.post_message(self.Searching(self._pattern))

    @property
    def is_searching(self) -> bool:
        """Whether typed letters go into a history search."""
        return self._pattern is not None

    def _find(self, older_than: int | None = None) -> None:
        assert self._pattern is not None
        hit = self.history.search(self._pattern, older_than=older_than)
        if hit is not None:
            self._hit = hit[0]
            self._show(hit[1])

    def _end_search(self) -> None:
        self._pattern = None
        self.post_message(self.Searching(None))

    def _position_to_cell(self, position: int) -> int:
        """Return where a character is drawn: control characters that were pasted take a cell, too."""
        return cell_len(expand_tabs_inline(visible(self.value[:position]), 4))

    # ------------------------------------------------------------------------------------------------ keys

    async def _on_key(self, event: events.Key) -> None:
        if self.completion.handle_key(event, self) or (self._pattern is not None and self._search_key(event)):
            pass
        elif event.key == "tab":
            self.completion.offer(self)
        elif event.key == "enter":
            self._enter()
        else:
            await super()._on_key(event)
            if event.is_printable:
                self.completion.letter_typed(self)
            return
        event.stop()
        event.prevent_default()

    def on_blur(self) -> None:
        """Close the completions."""
        self.completion.focus_lost(self)

    def on_input_changed(self) -> None:
        """Close completions that no longer fit."""
        self.completion.text_changed(self)

    def _search_key(self, event: events.Key) -> bool:
        """Handle a key of the history search; False if it ends the search and counts as usual."""
        assert self._pattern is not None
        if event.key == "backspace":
            self._pattern = self._pattern[:-1]
        elif event.is_printable and event.character:
            self._pattern += event.character
        else:
            if event.key == "escape":
                self.value = ""
            self._end_search()
            return event.key == "escape"
        self._find()
        self.post_message(self.Searching(self._pattern))
        return True

    def _enter(self) -> None:
        line, self.value = self.value, ""
        self.history.forget_place()
        self._entered([line] if self.pending.is_empty else self.pending.take(line))

    def _on_paste(self, event: events.Paste) -> None:
        """Carry out several pasted lines one after the other, as far as they succeed.

        A last one without its end stays to be edited.
        """
        event.stop()
        event.prevent_default()
        lines = event.text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
        if len(lines) == 1:
            self.insert_text_at_cursor(lines[0])
            return
        lines[0] = self.value[: self.cursor_position] + lines[0]
        self.value = lines.pop()
        self.cursor_position = len(self.value)
        self._entered([line for line in lines if line.strip()])
