"""Which lines of a program are folded: those at its end that say what it must show. Text in, row out."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

HEADING = "-- What it must show"
EXPECTATIONS = ("--?", "--|")


def fold_row(lines: Sequence[str]) -> int | None:
    """Return the row that stays of the expectations at a program's end; None if it has none."""
    first = len(lines)
    while first and (not lines[first - 1].strip() or lines[first - 1].startswith(EXPECTATIONS)):
        first -= 1
    if not any(line.startswith(EXPECTATIONS) for line in lines[first:]):
        return None
    if first and lines[first - 1].startswith(HEADING):
        return first - 1
    return next(row for row in range(first, len(lines)) if lines[row].startswith(EXPECTATIONS))


def folded_line(line: str, hidden: int) -> str:
    """Return what is drawn for the row that stays."""
    return f"{HEADING if line.startswith(HEADING) else line} ({hidden} lines folded, Alt+Z)"
