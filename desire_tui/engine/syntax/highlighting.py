"""Classes of a line's parts for an editor, from the parser's own tokens: the two cannot disagree."""

from __future__ import annotations

from functools import cache, lru_cache
from typing import TYPE_CHECKING, Literal

from desire_tui.engine.syntax.parse import numbered, would_spoil
from desire_tui.engine.syntax.statement_tokens import LETTER, MATFUN, NAME, NUMBER, OCTAL, RAW, STRING
from desire_tui.engine.syntax.tokens import scan

if TYPE_CHECKING:
    from collections.abc import Sequence

ROWS_SEARCHED = 100
"""Longer statements are coloured as if they began anew."""
Class = Literal["keyword", "function", "system", "string", "comment", "number", "operator", "name"]

_CLASSES: dict[str, Class] = {
    NUMBER: "number", OCTAL: "number", STRING: "string", RAW: "string", LETTER: "keyword", MATFUN: "function",
}  # fmt: skip


@cache
def _known() -> tuple[frozenset[str], frozenset[str]]:
    """Names of library functions and of system variables; imported late, they bring NumPy."""
    from desire_tui.engine.library import LIBRARY
    from desire_tui.engine.values import SYSTEM_VARIABLES

    return frozenset(LIBRARY), frozenset(SYSTEM_VARIABLES) | {"PI"}


def highlight(text_line: str) -> list[tuple[int, int, Class]]:
    """Return (start, end, class) for the parts of one line, in order. A line number counts as a comment."""
    skipped = numbered(text_line)
    found: list[tuple[int, int, Class]] = [(0, skipped, "comment")] if skipped else []
    line = scan(text_line[skipped:])
    found += [(skipped + start, skipped + end, "comment") for start, end in line.comments]
    for chunk in line.chunks:
        kinds = chunk.kinds
        base = skipped + chunk.base
        for i, kind in enumerate(kinds):
            found.append((base + chunk.starts[i], base + chunk.ends[i], _class(chunk.texts, kinds, i, kind)))
    found.sort()
    return found


def before(lines: Sequence[str], row: int) -> str:
    """Return the rows of a statement that goes on in this row, each with its line feed; else an empty text.

    With it in front `highlight` shows what the row holds: no statement begins there.
    """
    top, start = row, row
    while top > 0 and row - top < ROWS_SEARCHED:
        top -= 1
        if _goes_on(lines[top]):
            start = top
        elif not lines[top].lstrip().startswith("--"):  # a comment may stand between
            break
    if start == row:
        return ""
    if (
        row == start + 1
        and not lines[start].rstrip().endswith("_")
        and _spoils(tuple(lines[start : _end(lines, row)]))
    ):
        return ""
    return "".join(f"{line}\n" for line in lines[start:row])


def _end(lines: Sequence[str], row: int) -> int:
    """Return the row behind the statement that goes on in `row`."""
    most = min(len(lines), row + ROWS_SEARCHED)
    ends = (
        at for at in range(row, most) if not _goes_on(lines[at]) and not lines[at].lstrip().startswith("--")
    )
    return next(ends, most - 1) + 1


@lru_cache(maxsize=4096)
def _goes_on(line: str) -> bool:
    return line != "" and scan(line[numbered(line) :]).continues


@lru_cache(maxsize=256)
def _spoils(rows: tuple[str, ...]) -> bool:
    return would_spoil(list(rows))


def _class(texts: list[str], kinds: list[str], i: int, kind: str) -> Class:
    if kind == NAME:
        text = texts[i]
        functions, system = _known()
        if text in system:
            return "system"
        called = i + 1 < len(kinds) and kinds[i + 1] == "("
        return "function" if text in functions and called else "name"
    known = _CLASSES.get(kind)
    if known is not None:
        return known
    return "keyword" if kind[0].isalpha() else "operator"
