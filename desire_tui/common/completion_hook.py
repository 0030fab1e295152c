"""What a text that is being typed reports to whoever completes its words."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from textual import events


class CompletionHook(Protocol):
    """Follows the editor's texts and the prompt; `target` is the one that reports."""

    def handle_key(self, event: events.Key, target: Any) -> bool:
        """Use up a key before the text gets it; False if it is the text's own."""

    def letter_typed(self, target: Any) -> None:
        """Follow a letter that was typed."""

    def text_changed(self, target: Any) -> None:
        """Follow a change of text or cursor."""

    def focus_lost(self, target: Any) -> None:
        """React when the text lost the focus."""

    def offer(self, target: Any) -> None:
        """Offer completions, which were asked for."""
