"""Which bracket belongs to which, searched for in the neighbourhood only: a key never waits for it."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from desire_tui.language.line_tokens import brackets_in

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from textual.document._document import Location

PAIRS = {"(": ")", "[": "]", "{": "}"}
OPENING = {closing: opening for opening, closing in PAIRS.items()}
LINES_MAX, COLUMNS_MAX = 200, 20_000
"""So many lines are searched, and so many characters of each."""
TOKENS_MAX = 2000
"""In longer lines (characters) every bracket counts, in shorter ones none of a comment or a string."""
_BRACKET = re.compile(r"[()\[\]{}]")


def partner(lines: Sequence[str], at: Location) -> Location | None:
    """Return the place of the bracket that belongs to the one at `at`; None if there is none nearby."""
    own = lines[at[0]][at[1]]
    forward = own in PAIRS
    waiting: list[str] = []
    for bracket, place in _onward(lines, at) if forward else _backward(lines, at):
        if not waiting and place != at:
            return None  # the one at `at` stands in a comment or a string
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
        for where, bracket in _brackets(lines[number], first, first + COLUMNS_MAX):
            yield bracket, (number, where)


def _backward(lines: Sequence[str], at: Location) -> Iterator[tuple[str, Location]]:
    row, column = at
    for number in range(row, max(row - LINES_MAX, -1), -1):
        last = column + 1 if number == row else len(lines[number])
        found = _brackets(lines[number], max(0, last - COLUMNS_MAX), last)
        yield from ((bracket, (number, where)) for where, bracket in reversed(found))


def _brackets(line: str, first: int, last: int) -> list[tuple[int, str]]:
    """Return the brackets between two columns, with the column of each."""
    if len(line) > TOKENS_MAX:
        return [(found.start(), found.group()) for found in _BRACKET.finditer(line, first, last)]
    return [(at, bracket) for at, bracket in brackets_in(line) if first <= at < last]
