"""What the command palette finds: titles first, then descriptions, words of the command line and synonyms.

Themes are listed, too; the one that is marked is tried on the screen.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.command import DiscoveryHit, Hit, Hits, Provider

from desire_tui.commands import COMMANDS
from desire_tui.common.command_search import is_described
from desire_tui.common.themes import ThemeChoice
from desire_tui.desktop.themed_app import ThemedApp

if TYPE_CHECKING:
    from collections.abc import Iterator

IN_TITLE, BY_DESCRIPTION = 2000.0, 1000.0
"""A title that has the query in one piece comes first, then descriptions, then letters that lie scattered."""


class Actions(Provider):
    """The actions of the command table."""

    async def discover(self) -> Hits:
        """Offer all actions, in the order of the table."""
        for title, about, callback, _ in self.app.get_system_commands(self.screen):
            yield DiscoveryHit(title, callback, help=about)
        for title, choice in self._themes():
            yield DiscoveryHit(title, choice)

    async def search(self, query: str) -> Hits:
        """Offer actions in whose title the letters stand, or whose description has all words; themes."""
        matcher = self.matcher(query)
        listed = (command for command in COMMANDS if command.id != "view.palette")
        offered = self.app.get_system_commands(self.screen)
        for command, (title, about, callback, _) in zip(listed, offered, strict=True):
            score = matcher.match(title)
            if query.casefold() in title.casefold():
                score += IN_TITLE
            elif is_described(command, query):
                score += BY_DESCRIPTION
            if score > 0:
                yield Hit(score, matcher.highlight(title), callback, help=about)
        for title, choice in self._themes():
            if (score := matcher.match(title)) > 0:
                score += IN_TITLE * (query.casefold() in title.casefold())
                yield Hit(score, matcher.highlight(title), choice)

    def _themes(self) -> Iterator[tuple[str, ThemeChoice]]:
        app = self.app
        assert isinstance(app, ThemedApp)
        for name in app.available_themes:
            yield f"Theme: {name}", ThemeChoice(name, app.choose_theme)
