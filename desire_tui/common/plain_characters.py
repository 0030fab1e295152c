"""Characters that fonts of text consoles have, in place of those that they lack.

The Linux console shows 256 or 512 characters: lines, blocks, arrows, but neither braille nor round corners.
"""

from __future__ import annotations

import os

_UPPER, _LOWER, _LEFT, _RIGHT = 0x1B, 0xE4, 0x47, 0xB8
"""Bits of a braille pattern: its dots by the half of the cell they lie in."""
_LIKE = {
    "╭┏╔": "┌", "╮┓╗": "┐", "╰┗╚": "└", "╯┛╝": "┘", "━═╌╍╴╶╸╺╼╾": "─", "┃║╎╏╵╷╹╻": "│",
    "▁▂▃▄▅▖▗": "▄", "▆▇▙▟": "█", "▔▘▝": "▀", "▛▜": "█", "▏▎▍▌": "▌", "▋▊▉": "█", "▕": "▐", "▚▞": "▒",
    "▸▶": "►", "◀": "◄", "●": "•", "○": "o", "✖×": "x", "✓": "+", "⚠": "!", "‹": "<", "›": ">",
    "–—−": "-", "’‘": "'", "“”": '"', "…": ".", "≤": "<", "≥": ">", "⌫": "<",
}  # fmt: skip


def _block(dots: int) -> str:
    """Return the block that covers the halves of a cell where a braille pattern has dots."""
    if not dots:
        return " "
    if not dots & _LOWER:
        return "▀"
    if not dots & _UPPER:
        return "▄"
    if not dots & _RIGHT:
        return "▌"
    return "█" if dots & _LEFT else "▐"


PLAIN = {0x2800 + dots: _block(dots) for dots in range(256)} | {
    ord(character): plain for characters, plain in _LIKE.items() for character in characters
}
"""For `str.translate`."""


def are_needed() -> bool:
    """Whether the terminal is a console whose font has few characters."""
    return os.environ.get("TERM") == "linux"
