"""Line numbers: those that a program bears, and those that its lines count by if it bears none.

The original numbers the lines of a text without numbers 210, 220, …; `go to`, `restore`, `edit`, `list` and
`note #` mean these. Blank lines do not count, comments do; joined rows are one line.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from desire_tui.engine.syntax.logical_lines import logical_lines, numbered_lines

if TYPE_CHECKING:
    from desire_tui.engine.syntax.logical_lines import NumberedLine

_RANGE = re.compile(r"([0-9]+)(?:[ \t]*-[ \t]*([0-9]+))?")


def rows_named(text: str, ranges: str) -> list[NumberedLine]:
    """Return the lines that a list such as `210-240, 260` names; those that are not there are left out."""
    wanted = [range(int(first[:9]), int((last or first)[:9]) + 1) for first, last in _RANGE.findall(ranges)]
    return [line for line in numbered_lines(text) if any(line.number in numbers for numbers in wanted)]


def listing(text: str, ranges: str) -> str:
    """Return the named lines of a program with their numbers, each with a line feed."""
    rows = text.split("\n")
    found = rows_named(text, ranges)
    bears = _bears_numbers(text)
    shown = []
    for number, lines in found:
        first, *rest = rows[lines.start : lines.stop]
        shown += [first if bears else f"{number} {first}", *rest]
    return "".join(f"{row.rstrip()}\n" for row in shown)


def with_numbers(text: str) -> str:
    """Return a program with its lines numbered; parsed again, it is the same program.

    Lines that go on from the one above bear no number: it would be part of their expression. Neither do
    blank and header lines, and a program that has numbers keeps them, for its `go to` and `restore`.
    """
    if _bears_numbers(text):
        return text if text.endswith("\n") else text + "\n"
    rows = text.removesuffix("\n").split("\n")
    lines = numbered_lines(text)
    width = len(str(lines[-1].number)) if lines else 0
    for number, where in lines:
        rows[where.start] = f"{number:>{width}} {rows[where.start]}"
    return "\n".join(row.rstrip() for row in rows) + "\n"


def _bears_numbers(text: str) -> bool:
    return any(number is not None for _, _, number, _ in logical_lines(text))
