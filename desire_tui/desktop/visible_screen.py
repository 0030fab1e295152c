"""Nothing a program or a file holds reaches the terminal as a command: Textual draws visible text only.

Textual and Rich delete five control characters from text and let all others through to the terminal. Their
functions for that are replaced by `visible`, which keeps every character's column; a text's width is then
counted as it is drawn. What a widget draws without these two classes is made visible where it is turned into
bytes: there is one such place. There, too, characters are replaced that a console's font lacks.
"""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Any

import rich.text
import textual.content
from rich.color import Color, ColorSystem
from rich.segment import Segment
from rich.style import Style
from textual.strip import Strip

from desire_tui.common.plain_characters import PLAIN
from desire_tui.engine.visible_text import visible, visible_line

if TYPE_CHECKING:
    from rich.console import Console

_render = Strip.render


def teach(*, plain: bool = False) -> None:
    """Let Textual draw visible text; a second call changes nothing. `plain`: of characters every font has."""
    library: Any = textual.content
    library._strip_control_codes = visible  # noqa: SLF001 - no public way (Textual is pinned)
    library = rich.text
    library.strip_control_codes = visible
    drawing: Any = Strip
    drawing.render = _render_plain if plain else _render_visible


def _render_plain(strip: Strip, console: Console) -> str:
    """Return a row as what is sent to a terminal with few characters."""
    row = []
    for text, style, control in strip:
        there = text if control else text.translate(PLAIN)
        row.append(Segment(there, None if style is None else _plain_style(style), control))
    return _render_visible(Strip(row), console)


_BLACK, _GREY = 0, 8
_COLOURED = frozenset((2, 3, 6, 10, 11, 14))
"""Green, brown, cyan: grounds on which black can be read and grey cannot."""


@lru_cache(1000)
def _plain_style(style: Style) -> Style:
    """Return a style without dark grey on a coloured ground, which bold black is, too, on a console."""
    number, ground = _number(style.color), _number(style.bgcolor)
    if number == _GREY and ground in _COLOURED:
        return style + Style(color="black", bold=False)
    return style + Style(bold=False) if style.bold and number == _BLACK else style


def _number(color: Color | None) -> int | None:
    """Return which of a console's sixteen colours is meant."""
    return None if color is None else color.downgrade(ColorSystem.STANDARD).number


def _render_visible(strip: Strip, console: Console) -> str:
    """Return a row as what is sent to the terminal."""
    if all(text.isprintable() for text, _, control in strip if not control):
        return _render(strip, console)
    return _render(
        Strip([Segment(s.text if s.control else visible_line(s.text), s.style, s.control) for s in strip]),
        console,
    )
