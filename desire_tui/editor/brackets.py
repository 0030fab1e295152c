"""Which bracket belongs to which, searched for in the neighbourhood only: a key never waits for it."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from textual.document._document import Location

PAIRS = {"(": ")", "[": "]", "{": "}"}
OPENING = {closing: opening for opening, closing in PAIRS.items()}
LINES_MAX, COLUMNS_MAX = 200, 20_000
"""So many lines are searched, and so many characters of each."""
_BRACKET = re.compile(r"[()\[\]{}]")


def partner(lines: Sequence[str], at: Location) -> Location | None:
    """Return the place of the bracket that belongs to the one at `at`; None if there is none nearby."""
    own = lines[at[0]][at[1]]
    forward = own in PAIRS
    waiting: list[str] = []
    for bracket, place in _onward(lines, at) if forward else _backward(lines, at):
        if (bracket in PAIRS) == forward:
            waiting.append(bracket)
            continue
        if (PAIRS if forward else OPENING)[waiting.pop()] != bracket:
            return None
        if not waiting:
            return place
    return None


def _onward(lines: Sequence[str], at: Location) -> Iterator[tuple[str, Location]]:
    row, column = at
    for number in range(row, min(row + LINES_MAX, len(lines))):
        first = column if number == row else 0
        for found in _BRACKET.finditer(lines[number], first, first + COLUMNS_MAX):
            yield found.group(), (number, found.start())


def _backward(lines: Sequence[str], at: Location) -> Iterator[tuple[str, Location]]:
    row, column = at
    for number in range(row, max(row - LINES_MAX, -1), -1):
        last = column + 1 if number == row else len(lines[number])
        found = list(_BRACKET.finditer(lines[number], max(0, last - COLUMNS_MAX), last))
        yield from ((one.group(), (number, one.start())) for one in reversed(found))
