"""The app's colours: themes complete in every colour, tried before they are chosen, remembered."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual import on
from textual.app import App
from textual.command import CommandPalette

from desire_tui.common import themes
from desire_tui.common.remembered import remember, remembered
from desire_tui.desktop.palette_colours import PaletteColours
from desire_tui.desktop.quick_stylesheet import QuickStylesheet

if TYPE_CHECKING:
    from textual.theme import Theme

UNCHOSEN = "dark"
OURS = {theme.name: theme for theme in themes.THEMES}


class ThemedApp(App[None]):
    """Has our themes and Textual's, but not those of the terminal's own colours, which no number tells."""

    def __init__(self) -> None:
        self._completed: dict[str, Theme] = {}
        self._has_few_colours = False
        self._palette_colours: PaletteColours | None = None
        """Those that an open palette was filled with."""
        self._chosen_theme = self._configured_theme = UNCHOSEN
        super().__init__()
        self.stylesheet = QuickStylesheet(variables=self.get_css_variables())
        for theme in themes.THEMES:
            self.register_theme(theme)
        self._has_few_colours = self.console.color_system == "standard"
        self._completed.clear()

    @property
    def available_themes(self) -> dict[str, Theme]:
        """Themes by name, ours first."""
        return OURS | {name: theme for name, theme in self._registered_themes.items() if not theme.ansi}

    @property
    def current_theme(self) -> Theme:
        """The theme in all its colours; on a terminal of sixteen colours one of these."""
        if (theme := self._completed.get(self.theme)) is None:
            theme = self.available_themes.get(self.theme, OURS[UNCHOSEN])
            if self._has_few_colours:
                theme = themes.SIXTEEN_DARK if theme.dark else themes.SIXTEEN_LIGHT
            theme = self._completed[self.theme] = themes.completed(theme)
        return theme

    def get_css_variables(self) -> dict[str, str]:
        """Return the colours of the theme, and that of frames."""
        variables = super().get_css_variables()
        return variables | {"frame": themes.frame(variables)}

    def begin_with_theme(self, configured: str) -> None:
        """Take the theme chosen last, unless the configuration was changed since."""
        self._configured_theme = configured
        kept = remembered()
        chosen = kept.get("theme") if kept.get("instead_of") == configured else None
        there = list(self.available_themes)
        wanted = next((name for name in (chosen, configured) if name in there), UNCHOSEN)
        self._chosen_theme = self.theme = wanted

    def try_theme(self, name: str | None) -> None:
        """Show a theme without choosing it; None: the chosen one again."""
        wanted = name if name in self.available_themes else self._chosen_theme
        if wanted != self.theme:
            self.theme = wanted

    def choose_theme(self, name: str) -> None:
        """Take a theme from now on."""
        self._chosen_theme = self.theme = name
        remember(theme=name, instead_of=self._configured_theme)

    @on(CommandPalette.OptionHighlighted)
    def _marked_in_palette(self, event: CommandPalette.OptionHighlighted) -> None:
        choice = getattr(getattr(event.highlighted_event.option, "hit", None), "command", None)
        if isinstance(self.screen, CommandPalette):
            self._palette_colours = PaletteColours.of(self.screen)
        self.try_theme(choice.name if isinstance(choice, themes.ThemeChoice) else None)

    def follow_theme(self) -> None:
        """Take over the colours of a new theme where they are not CSS's."""
        if isinstance(self.screen, CommandPalette) and self._palette_colours is not None:
            self._palette_colours.give_way(self.screen)
            self._palette_colours = PaletteColours.of(self.screen)

    @on(CommandPalette.Closed)
    def _palette_closed(self) -> None:
        self.try_theme(None)
