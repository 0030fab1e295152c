"""Colours: the desktop's themes, and the editor's colours that go with each."""

from __future__ import annotations

from rich.style import Style
from textual.color import Color
from textual.theme import Theme
from textual.widgets.text_area import TextAreaTheme

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

THEMES = (DARK, LIGHT, CONTRAST, PUBLICATION)
NAMES = tuple(theme.name for theme in THEMES)

_WORDS = ("keyword", "function", "system", "string", "comment", "number", "operator", "name")
_COLOURS = {
    "dark": ("#82aaff", "#7fd1b9", "#e5a86b", "#a8cc8c", "#a0a9b9", "#d9a0e0", "#b4bac6", "#d7dae0"),
    "light": ("#0b4fa0", "#00695c", "#8a4b00", "#2f6b1f", "#5a616b", "#7a2f8f", "#444a52", "#23272e"),
    "contrast": ("#5fd7ff", "#5fffaf", "#ffaf5f", "#afff87", "#bcbcbc", "#ff87ff", "#ffffff", "#ffffff"),
    "publication": ("#000000", "#000000", "#000000", "#404040", "#555555", "#000000", "#000000", "#000000"),
}
_CHOSEN = {"dark": "#2a3a50", "light": "#dbe8f5", "contrast": "#303030", "publication": "#d8d8d8"}
"""What selected text stands on: the colours of words stay as they are."""

_FOUND = {"dark": "#3a311a", "light": "#f2dc98", "contrast": "#403200", "publication": "#cccccc"}
"""What stands behind text that a search found."""


def quiet(theme: Theme) -> str:
    """Return the colour of text that matters less; it can be read all the same."""
    ground, text = Color.parse(str(theme.surface)), Color.parse(str(theme.foreground))
    return ground.blend(text, 0.75).hex


def editor_theme(theme: Theme) -> TextAreaTheme:
    """Return the editor's colours for a theme.

    For a theme that is not ours, those of our light or dark one.
    """
    name = theme.name if theme.name in _COLOURS else ("dark" if theme.dark else "light")
    styles = {word: Style(color=colour) for word, colour in zip(_WORDS, _COLOURS[name], strict=True)}
    styles["keyword"] += Style(bold=True)
    styles["comment"] += Style(italic=True)
    chosen = Style(bgcolor=_CHOSEN[name])
    styles["error"] = Style(underline=True, color=str(theme.error))
    styles["warning"] = Style(underline=True)
    styles["found"] = Style(bgcolor=_FOUND[name])
    return TextAreaTheme(name=f"desire-{theme.name}", syntax_styles=styles, selection_style=chosen)
