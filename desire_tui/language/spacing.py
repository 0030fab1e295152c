"""Blanks between the tokens of a statement: one style for all programs, that of the examples.

`x = -k*(a + b)^2`, `y[i+1] = f(u, v; w)`: blanks around `=`, relations, `+` and `-`, behind commas; none
around `*`, `/`, `^`. Left to the author: `+`, `-` and commas within subscripts, and commas of `data`, which
may be pictures.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.syntax.statement_tokens import (
    LETTER,
    MATFUN,
    NAME,
    OPERAND_END,
    PRIME,
    RAW,
    STRING,
)
from desire_tui.engine.syntax.words import CLOSERS, OPENERS, RELATIONS

if TYPE_CHECKING:
    from collections.abc import Iterator

    from desire_tui.engine.syntax.statement_tokens import StatementTokens

_OPEN = frozenset(OPENERS.values())
_SIGNS = frozenset({"+", "-"})
_TIGHT = frozenset({"*", "/", "^"})
_BEFORE_CHANNEL = frozenset({"#", "##", "$", "%", "%%"})
"""Marks before an operand: `write #1, $n`; behind a name `%` and `#` belong to it."""
_SUBSCRIPTS = frozenset({"[", "{"})


def blanks_before(tokens: StatementTokens, gaps: list[str]) -> Iterator[str]:
    """Yield what stands before each token of a statement; `gaps` is what the author wrote there."""
    kinds = tokens.kinds
    open_brackets: list[str] = []
    signs = _signs(kinds)
    for place, kind in enumerate(kinds):
        if kind in CLOSERS and open_brackets:
            open_brackets.pop()
        yield "" if place == 0 else _blank(kinds, place, signs, open_brackets, gaps)
        if kind in _OPEN:
            open_brackets.append(kind)


def _signs(kinds: list[str]) -> set[int]:
    """Return the places of `+` and `-` that are signs of one operand."""
    found = set()
    for place, kind in enumerate(kinds):
        if kind in _SIGNS and (
            place == 0 or kinds[place - 1] not in OPERAND_END or _is_mark(kinds, place - 1)
        ):
            found.add(place)
    return found


def _is_mark(kinds: list[str], place: int) -> bool:
    """Whether a `#` or `%` stands before its operand."""
    return kinds[place] in _BEFORE_CHANNEL and (place == 0 or kinds[place - 1] not in {NAME, "]"})


def _blank(kinds: list[str], place: int, signs: set[int], brackets: list[str], gaps: list[str]) -> str:
    before, kind, gap = kinds[place - 1], kinds[place], gaps[place]
    if before in _OPEN or kind in CLOSERS or kind in {",", ";", PRIME}:
        return ""
    if before in {",", ";"}:
        authors = kinds[0] == "data" or (brackets and brackets[-1] in _SUBSCRIPTS)
        return " " if gap or not authors else ""
    if kind in {"(", "[", "{"} and before in {NAME, MATFUN}:
        return ""
    if before == "d/dt" and kind == "(":
        return " " if gap else ""
    if before == LETTER or kind in {RAW, STRING}:
        return " " if gap or kind == RAW or before != LETTER else ""
    if place - 1 in signs:
        return " " if kind in _SIGNS else ""
    if _is_mark(kinds, place - 1):
        return ""
    if kind in {"%", "#"} and not _is_mark(kinds, place):
        return " " if kinds[0] == "CLEARN" and place == len(kinds) - 1 and gap else ""
    if kind == "^" and kinds[place + 1 : place + 2] == ["="]:
        return ""
    if place > 1 and (kind in _TIGHT or before in _TIGHT) and kind != "=":
        return ""
    if before in RELATIONS or kind in RELATIONS:
        return " "
    if (kind in _SIGNS or before in _SIGNS) and brackets and brackets[-1] in _SUBSCRIPTS:
        sign = place - 1 if before in _SIGNS else place  # of `+ -x` the blanks around `+` count
        return " " if gaps[sign] and gaps[sign + 1] else ""
    return " "
