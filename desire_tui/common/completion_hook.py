"""What a text being typed tells whoever completes its words."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from textual import events


class TypingAid:
    """Helps nobody; the completer takes its place as soon as it is there."""

    def takes(self, event: events.Key, target: Any) -> bool:
        """Use up a key before the text gets it; False if it is the text's own."""
        del event, target
        return False

    def typed(self, target: Any) -> None:
        """Follow a letter that was typed."""

    def moved(self, target: Any) -> None:
        """Follow a change of text or cursor."""

    def left(self, target: Any) -> None:
        """Take notice that the text lost the keys."""

    def wanted(self, target: Any) -> None:
        """Offer completions, which were asked for."""
