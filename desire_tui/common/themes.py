"""Colours: the desktop's themes, and the editor's colours that go with each."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rich.style import Style
from textual.color import Color
from textual.theme import Theme
from textual.widgets.text_area import TextAreaTheme

from desire_tui.engine.data_classes import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Callable

DARK = Theme(
    "dark", primary="#4fa3d9", secondary="#3d7ea6", accent="#e5c07b", foreground="#d7dae0",
    background="#15181e", surface="#1a1e25", panel="#262c36", success="#7fc97f",
    warning="#e5c07b", error="#f4737b",
    dark=True,
)  # fmt: skip
LIGHT = Theme(
    "light", primary="#195f92", secondary="#4a7896", accent="#8a5a00", foreground="#23272e",
    background="#f4f4f0", surface="#fbfbf8", panel="#dfe2e6", success="#1f7a33",
    warning="#8a5a00", error="#b3202c",
    dark=False,
)  # fmt: skip
CONTRAST = Theme(
    "contrast", primary="#00d7ff", secondary="#00afff", accent="#ffff00", foreground="#ffffff",
    background="#000000", surface="#000000", panel="#303030", success="#00ff00",
    warning="#ffff00", error="#ff7070",
    dark=True,
)  # fmt: skip
PUBLICATION = Theme(
    "publication", primary="#303030", secondary="#505050", accent="#000000", foreground="#000000",
    background="#ffffff", surface="#ffffff", panel="#e4e4e4", success="#000000",
    warning="#303030",
    error="#900000",
    dark=False,
)  # fmt: skip

SIXTEEN_DARK = Theme(
    "sixteen-dark", primary="#55ffff", secondary="#00aaaa", accent="#ffff55", foreground="#ffffff",
    background="#000000", surface="#000000", panel="#0000aa", success="#55ff55",
    warning="#ffff55", error="#ff5555",
    dark=True,
    variables={"block-cursor-blurred-background": "#00aaaa", "block-cursor-blurred-foreground": "#000000"},
)  # fmt: skip
SIXTEEN_LIGHT = Theme(
    "sixteen-light", primary="#0000aa", secondary="#555555", accent="#aa00aa", foreground="#000000",
    background="#ffffff", surface="#ffffff", panel="#ffffff", success="#00aa00",
    warning="#aa00aa", error="#aa0000",
    dark=False,
    variables={"block-cursor-blurred-background": "#aaaaaa", "block-cursor-blurred-foreground": "#000000"},
)  # fmt: skip
"""What stands for every theme where the terminal has the sixteen colours of old consoles only: a colour
between them would become its neighbour, perhaps the ground's own."""

THEMES = (DARK, LIGHT, CONTRAST, PUBLICATION)
NAMES = tuple(theme.name for theme in THEMES)

_WORKED_OUT = (
    "secondary", "warning", "error", "success", "accent", "foreground", "background", "surface", "panel",
)  # fmt: skip
"""Colours that a theme may leave to be worked out from others."""
_WORDS = ("keyword", "function", "system", "string", "comment", "number", "operator", "name")
_COLOURS = {
    "dark": ("#82aaff", "#7fd1b9", "#e5a86b", "#a8cc8c", "#a0a9b9", "#d9a0e0", "#b4bac6", "#d7dae0"),
    "light": ("#0b4fa0", "#00695c", "#8a4b00", "#2f6b1f", "#5a616b", "#7a2f8f", "#444a52", "#23272e"),
    "contrast": ("#5fd7ff", "#5fffaf", "#ffaf5f", "#afff87", "#bcbcbc", "#ff87ff", "#ffffff", "#ffffff"),
    "publication": ("#000000", "#000000", "#000000", "#404040", "#555555", "#000000", "#000000", "#000000"),
    "sixteen-dark": ("#55ffff", "#55ffff", "#ffff55", "#55ff55", "#aaaaaa", "#ff55ff", "#ffffff", "#ffffff"),
    "sixteen-light": ("#0000aa", "#0000aa", "#aa00aa", "#555555", "#555555", "#aa0000", "#000000", "#000000"),
}
_CHOSEN = {
    "dark": "#2a3a50", "light": "#dbe8f5", "contrast": "#303030", "publication": "#d8d8d8",
    "sixteen-dark": "#0000aa", "sixteen-light": "#aaaaaa",
}  # fmt: skip
"""What selected text stands on: the colours of words stay as they are."""

_FOUND = {
    "dark": "#3a311a", "light": "#f2dc98", "contrast": "#403200", "publication": "#cccccc",
    "sixteen-dark": "#0000aa", "sixteen-light": "#aaaaaa",
}  # fmt: skip
"""What stands behind text that a search found."""


def completed(theme: Theme) -> Theme:
    """Return a theme with all its colours: those of Textual's leave some to be worked out."""
    colours = theme.to_color_system().generate()
    worked_out: dict[str, Any] = {name: getattr(theme, name) or colours[name] for name in _WORKED_OUT}
    return replace(theme, **worked_out)


def quiet(theme: Theme) -> str:
    """Return the colour of text that matters less; it can be read all the same."""
    ground, text = Color.parse(str(theme.surface)), Color.parse(str(theme.foreground))
    return ground.blend(text, 0.75).hex


def frame(variables: dict[str, str]) -> str:
    """Return the colour of the lines around a pane that does not have the focus, by a theme's colours."""
    return Color.parse(variables["surface"]).blend(Color.parse(variables["foreground"]), 0.5).hex


def editor_theme(theme: Theme) -> TextAreaTheme:
    """Return the editor's colours for a theme.

    For a theme that is not ours, those of our light or dark one.
    """
    name = theme.name if theme.name in _COLOURS else ("dark" if theme.dark else "light")
    styles = {word: Style(color=colour) for word, colour in zip(_WORDS, _COLOURS[name], strict=True)}
    styles["keyword"] += Style(bold=True)
    if not name.startswith("sixteen"):  # consoles show another colour for it
        styles["comment"] += Style(italic=True)
    chosen = Style(bgcolor=_CHOSEN[name])
    styles["error"] = Style(underline=True, color=str(theme.error))
    styles["warning"] = Style(underline=True)
    styles["found"] = Style(bgcolor=_FOUND[name])
    return TextAreaTheme(name=f"desire-{theme.name}", syntax_styles=styles, selection_style=chosen)


@dataclass(frozen=True)
class ThemeChoice:
    """What a theme's entry does; while it is marked its theme is shown."""

    name: str
    choose: Callable[[str], object]

    def __call__(self) -> None:
        """Take the theme."""
        self.choose(self.name)
