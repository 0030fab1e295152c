"""Styles of what a graph is drawn with: curves, net and white paper."""

from __future__ import annotations

from functools import lru_cache

from rich.color import Color
from rich.style import Style

NO_COLOR = 255
"""As in `engine.outputs.braille_canvas`, which brings NumPy; a test holds them together."""
WHITE_STYLE = Style(color="#202020", bgcolor="#ffffff")


@lru_cache(maxsize=256)
def curve_style(color: int, *, white: bool) -> Style:
    """Return the style of a curve's colour number on a black or white background."""
    from desire_tui.engine.graph.colors import curve_rgb

    return Style(color=Color.from_rgb(*curve_rgb(color, white=white)))


def net_style(color: int, *, white: bool) -> Style:
    """Return the style of the net: one of the paper's own colour is not seen."""
    from desire_tui.engine.graph.colors import rgb

    return Style(color=Color.from_rgb(*rgb(color, white=white)))
