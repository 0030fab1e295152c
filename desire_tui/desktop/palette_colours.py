"""Textual's palette keeps the colours it was filled with: they follow a theme that is tried in it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from textual.command import CommandList, CommandPalette
from textual.content import Content, Span
from textual.style import Style

if TYPE_CHECKING:
    from typing import Self


class PaletteColours(NamedTuple):
    """What letters that were found, and descriptions, look like."""

    found: Style
    described: Style

    @classmethod
    def of(cls, palette: CommandPalette) -> Self:
        """Return those of the present theme."""
        return cls(
            palette.get_visual_style("command-palette--highlight", partial=True),
            Style.from_styles(palette.get_component_styles("command-palette--help-text")),
        )

    def give_way(self, palette: CommandPalette) -> None:
        """Replace these, with which a palette was filled, by those of the present theme."""
        new = dict(zip(self, PaletteColours.of(palette), strict=True))
        listed = palette.query_one(CommandList)
        for place, option in enumerate(listed.options):
            prompt = option.prompt
            if isinstance(prompt, Content):
                spans = [
                    Span(s.start, s.end, new.get(s.style, s.style) if isinstance(s.style, Style) else s.style)
                    for s in prompt.spans
                ]
                listed.replace_option_prompt_at_index(place, Content(prompt.plain, spans))
