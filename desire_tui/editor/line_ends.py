"""What ends the lines of a text: each line keeps its own end, new ones get that of most lines."""

from __future__ import annotations

import re
from difflib import SequenceMatcher
from itertools import chain
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import Self

_END = re.compile(r"\r\n|\r|\n")
NAMES = {"\n": "LF", "\r\n": "CRLF", "\r": "CR"}


class EndedText(str):
    """A text to put into a program, with the end of each of its lines; the last one is its line's there."""

    __slots__ = ("ends",)
    ends: Sequence[str]

    def __new__(cls, text: str, ends: Sequence[str]) -> Self:
        """Give a text its ends."""
        made = super().__new__(cls, text)
        made.ends = ends
        return made


def with_line_feeds(text: str) -> str:
    """Return a text whose lines end in line feeds, whatever they ended in."""
    return text.replace("\r\n", "\n").replace("\r", "\n") if "\r" in text else text


def ends_of(text: str) -> list[str]:
    """Return the end of each line; the last one has none."""
    if "\r" not in text:
        return ["\n"] * text.count("\n") + [""]
    return [*_END.findall(text), ""]


def usual(ends: Sequence[str], otherwise: str = "\n") -> str:
    """Return the end of most lines."""
    counts = {end: ends.count(end) for end in NAMES}
    most = max(counts.values())
    if not most or counts[otherwise] == most:
        return otherwise
    return next(end for end, count in counts.items() if count == most)


def kind(ends: Sequence[str]) -> str:
    """Return what a user is told of a text's line ends: `LF`, `CRLF`, `CR`, or `mixed ends`."""
    found = {end for end in NAMES if end in ends}
    return "mixed ends" if len(found) > 1 else NAMES[found.pop()] if found else "LF"


def ended(lines: Sequence[str], ends: Sequence[str]) -> str:
    """Return a text as it stands in the file."""
    if ends.count("\n") == len(ends) - 1:
        return "\n".join(lines)
    if "\r" in ends and "\n" in ends:
        ends = [
            # a line that became empty: `\r` and `\n` side by side would be one end
            "\r\n" if end == "\n" and at and not lines[at] and ends[at - 1] == "\r" else end
            for at, end in enumerate(ends)
        ]
    return "".join(chain.from_iterable(zip(lines, ends, strict=True)))


def ends_after(removed: Sequence[str], new: int, before: str, after: str, end: str) -> list[str]:
    """Return the ends of the lines that stand where others were replaced.

    `removed`: the ends of the old lines. `new`: how many lines there are now. `before` and `after`: what is
    kept of the first old line and the last. A line keeps its end where what it says is kept.
    """
    *inner, last = removed
    if new == len(removed):
        return list(removed)
    if before and not after and last:
        return [removed[0]] + [end] * (new - 1)
    if not last and inner and before and not after and new > 1:
        return [inner[0]] + [end] * (new - 2) + [last]
    return [end] * (new - 1) + [last]


def following(old: Sequence[str], ends: Sequence[str], new: Sequence[str], end: str) -> list[str]:
    """Return the ends of lines that were written anew as a whole: those that are still there keep theirs."""
    last = ends[-1]
    if all(each == end for each in ends[:-1]) and last in ("", end):
        return [end] * (len(new) - 1) + [last]
    found = [end] * len(new)
    for _, first, beyond, at, at_beyond in SequenceMatcher(None, old, new, autojunk=False).get_opcodes():
        for row, to in zip(range(first, beyond), range(at, at_beyond), strict=False):
            found[to] = ends[row] or end
    found[-1] = last if not last else found[-1]
    return found
