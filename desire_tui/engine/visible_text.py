"""Text as it may be shown: whatever a terminal would obey, or not show at all, becomes a visible character.

A terminal takes control characters as commands (write the clipboard, change the title, type an answer), and
characters for the direction of writing or without a width make a line look like another one. Every place that
shows text shows it through `visible` or `visible_line`. Each such character becomes exactly one character of
width 1, so that columns counted in the text are columns on the screen.
"""

from __future__ import annotations

import re
from functools import cache
from typing import IO

HIDDEN = (
    "\x00-\x08\x0b-\x1f\x7f-\x9f"  # C0 without tab and newline, DEL, C1
    "\xad\u034f\u061c\u115f\u1160\u17b4\u17b5\u180b-\u180f\u200b-\u200f\u2028-\u202e\u2060-\u206f"
    "\u3164\ufeff\uffa0\ufff0-\ufffb"  # no width, or the direction of writing
    "\u0600-\u0605\u06dd\u070f\u0890\u0891\u08e2"  # signs that enclose the digits behind them
    "\U000110bd\U000110cd\U00013430-\U0001343f\U0001bca0-\U0001bca3\U0001d173-\U0001d17a"
    "\U000e0000-\U000e0fff"  # tags
    "\ud800-\udfff"  # halves of a character: no terminal's encoding has them
)
"""The characters that are replaced, as the inside of a regular expression's `[…]`."""
REPLACEMENT = "\N{REPLACEMENT CHARACTER}"


def visible(text: str) -> str:
    """Return the text, as long as it was, with only tab and newline left of what is not shown."""
    return text if text.isprintable() and text.isascii() else _hidden().sub(_sign, text)


def visible_line(text: str) -> str:
    """Return text that has to stay in one line, such as a name: tab and newline are made visible, too."""
    return text if text.isprintable() and text.isascii() else _hidden("\t\n").sub(_sign, text)


def visible_whole(text: str) -> str:
    """Return text of several lines whose ends are marked, so that none passes for what stands around it."""
    return visible(text).replace("\n", "␊\n")


def for_stream(text: str, stream: IO[str]) -> str:
    """Return what to write to a stream: a terminal gets visible text, files and pipes the text itself."""
    return visible(text) if stream.isatty() else text


@cache
def _hidden(others: str = "") -> re.Pattern[str]:
    """Return the pattern, made at first use: most processes show ASCII only, and this takes 1 ms."""
    return re.compile(f"[{others}{HIDDEN}]")


def _sign(match: re.Match[str]) -> str:
    """Control characters have pictures (␛), all others share one sign."""
    code = ord(match[0])
    if code < 0x20:
        return chr(0x2400 + code)
    return "\N{SYMBOL FOR DELETE}" if code == 0x7F else REPLACEMENT
