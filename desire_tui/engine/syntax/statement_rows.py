"""Which rows of a text belong together, for an editor that looks at single rows."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

from desire_tui.engine.syntax.logical_lines import goes_on, numbered, would_spoil

if TYPE_CHECKING:
    from collections.abc import Sequence

ROWS_SEARCHED = 100
"""Longer statements are taken as if they began anew."""


def before(lines: Sequence[str], row: int) -> str:
    """Return the rows of a statement that goes on in this row, each with its line feed; else an empty text.

    With it in front the row's tokens are what they really are: no statement begins there.
    """
    start = _possible_start(lines, row)
    while start < row:
        end = _end(lines, start, row)
        if row < end:
            return "".join(f"{line}\n" for line in lines[start:row])
        start = end
    return ""


def whole(lines: Sequence[str], row: int) -> str:
    """Return the rows of the statements that begin in a row; an empty text if it belongs to the one above."""
    return "" if before(lines, row) else "\n".join(lines[row : _end(lines, row, row)])


def _possible_start(lines: Sequence[str], row: int) -> int:
    """Return the first of the rows above that, looked at alone, all go on in the next one."""
    top = start = row
    while top > 0 and row - top < ROWS_SEARCHED:
        top -= 1
        if lines[top].rstrip().endswith("_") or _goes_on(lines[top], ""):
            start = top
        elif not lines[top].lstrip().startswith("--"):  # a comment may stand between
            break
    return start


def _end(lines: Sequence[str], start: int, row: int) -> int:
    """Return the row behind the statement that begins in row `start`, or one well behind `row`."""
    most = min(len(lines), row + ROWS_SEARCHED)
    at, more = start, ""
    while at < most:
        if more == "_":
            more = goes_on(
                lines[at], more, [lines[start][numbered(lines[start]) :], *lines[start + 1 : at + 1]]
            )
        else:
            more = _goes_on(lines[at], more)
        at += 1
        if not more:
            break
    joined = lines[start].rstrip().endswith("_")
    return start + 1 if at > start + 1 and not joined and _spoils(tuple(lines[start:at])) else at


@lru_cache(maxsize=4096)
def _goes_on(line: str, before: str) -> str:
    return goes_on(line if before else line[numbered(line) :], before) if line else ""


@lru_cache(maxsize=256)
def _spoils(rows: tuple[str, ...]) -> bool:
    return would_spoil(list(rows))
