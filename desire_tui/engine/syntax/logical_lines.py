"""A program's text as logical lines: their numbers, and rows that go on in the next one."""

from __future__ import annotations

import re
from itertools import accumulate, repeat
from operator import add
from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.cancellation import cancellation_point
from desire_tui.engine.nodes.assignments import Bare
from desire_tui.engine.nodes.program import Placed
from desire_tui.engine.quick_tuples import tuples
from desire_tui.engine.syntax.parsed_lines import (
    has_fault,
    known_line,
    known_plain_line,
    parsed_line,
    plain_line,
)
from desire_tui.engine.syntax.tokens import CONTINUES, scan

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from desire_tui.engine.syntax.parsed_lines import Entry

FIRST_NUMBER, NUMBER_STEP = 210, 10
"""How the lines of a program without numbers count."""
ROWS_LOOKED_AT = 50
"""Of more joined rows, the last one is looked at alone: else long statements would take time squared."""
_ROWS_AT_ONCE = 500
"""Of plain rows, between two points where the work can be broken off."""

_NUMBERED = re.compile(r"[ \t]*([0-9]+)(?=[ \t]*(?:\r?\Z|--|—)|[ \t]+[A-Za-z|])")
_HEADER = re.compile(r"[ \t]*(?:/[ \t]*(?:NEW)?[ \t\r]*\Z|PIC[ \t]*['\"‘’“”])")
_STARTS_ODD = frozenset("0123456789/P \t")


def logical_lines(text: str, *, command: bool = False) -> Iterator[tuple[Entry, int, int | None, range]]:
    """Yield each line (with its continuations), the offset of its text, its line number if any, its rows.

    Lines without statements are left out, unless they are numbered. Rows are counted from 0.
    """
    for piece in lines_and_runs(text, runs=False, command=command):
        assert not isinstance(piece, list)
        yield piece


def lines_and_runs(
    text: str, *, runs: bool = True, command: bool = False
) -> Iterator[list[Placed] | tuple[Entry, int, int | None, range]]:
    """Yield what `logical_lines` does; with `runs`, of neighbouring plain rows only their statements."""
    known = known_line
    rows = text.split("\n")
    count = len(rows)
    starts = [*accumulate(map(add, map(len, rows), repeat(1)), initial=0)]
    i = 0
    while i < count:
        if runs:
            plain, end = _plain_rows(rows, starts, i)
            if plain:
                yield plain
            if end > i:
                i = end
                continue
        at, line = starts[i], rows[i]
        first = i
        i += 1
        number = None
        if line[:1] in _STARTS_ODD and line and not command:
            if _HEADER.match(line):
                continue
            found = _NUMBERED.match(line)
            if found:
                number = int(found[1][:9])
                at += found.end()
                line = line[found.end() :]
        entry = known(line) or parsed_line(line)
        if entry[1] and i < count:
            parts = [line]
            more = entry[1]
            while more and i < count:
                parts.append(rows[i])
                more = goes_on(rows[i], more, parts)
                i += 1
            whole = parsed_line("\n".join(parts))
            if _swallowed(line, whole, parts):
                i = first + 1  # the next line is a statement of its own: report the unfinished one alone
            else:
                entry = whole
        cancellation_point()
        if entry[0] or number is not None:
            yield entry, at, number, range(first, i)


def _plain_rows(rows: Sequence[str], starts: Sequence[int], first: int) -> tuple[list[Placed], int]:
    """Return the statements of rows that are one assignment or equation each, and the first row that is not.

    Rows without statements may stand among them.
    """
    cancellation_point()
    nodes, places = [], []
    end = min(first + _ROWS_AT_ONCE, len(rows))
    for at in range(first, end):
        row = rows[at]
        item = known_plain_line(row)
        if item is None:
            item = None if row[:1] in _STARTS_ODD and numbered(row) else plain_line(row)
            if item is None:
                end = at
                break
        if item:
            nodes.append(item[0])
            places.append(starts[at] + item[1])
    return [*tuples(Placed, nodes, places, repeat(None))], end


def goes_on(row: str, before: str = "", rows: Sequence[str] = ()) -> str:
    """Return what makes a row go on in the next one, if anything (`LogicalLine.continues`).

    `before` is what made the row above go on in this one; `rows` are those above and the row itself: where
    `_` joins them, `run *` may be the end of `drun *`.
    """
    if before and before not in CONTINUES:
        return scan(before + row).continues  # the row begins inside a string
    if before and row.lstrip().startswith("--"):
        return before  # a comment may stand between
    more = (parsed_line(row))[1]
    if before == "_" and more not in ("", "_") and len(rows) <= ROWS_LOOKED_AT:
        return scan("\n".join(rows)).continues
    return more


def would_spoil(rows: list[str]) -> bool:
    """Whether the first of some rows only seems to go on in the others: `x =` before a good statement."""
    return _swallowed(rows[0], parsed_line("\n".join(rows)), rows)


def _swallowed(line: str, whole: Entry, parts: list[str]) -> bool:
    """Whether a line that only seems to go on (`x =`) would spoil a good statement in the next one."""
    if line.rstrip().endswith("_") or not has_fault(whole):
        return False
    rest = "\n".join(parts[1:])
    following = parsed_line(rest)
    return bool(following[0]) and not has_fault(following) and not isinstance(following[0][0][0], Bare)


def numbered(line: str) -> int:
    """Return how many characters of a line are its line number, or the whole length of a header line."""
    if _HEADER.match(line):
        return len(line)
    found = _NUMBERED.match(line)
    return found.end() if found else 0


def is_header(line: str) -> bool:
    """Whether a line is one of those that the original's editor put around a program."""
    return _HEADER.match(line) is not None


class NumberedLine(NamedTuple):
    """A line's number and its rows, counted from 0."""

    number: int
    rows: range


def numbered_lines(text: str) -> list[NumberedLine]:
    """Return the lines of a program by their numbers, in the order of the text."""
    rows = text.split("\n")
    own: list[NumberedLine] = []
    joined = {}
    for _, _, number, lines in logical_lines(text):
        joined[lines.start] = lines
        if number is not None:
            own.append(NumberedLine(number, lines))
    if own:
        return own
    counted: list[NumberedLine] = []
    at = 0
    while at < len(rows):
        lines = joined.get(at, range(at, at + 1))
        if rows[at].strip() and not is_header(rows[at]):
            counted.append(NumberedLine(FIRST_NUMBER + NUMBER_STEP * len(counted), lines))
        at = lines.stop
    return counted
