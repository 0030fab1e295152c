"""Programs in one layout: blanks between words, blocks indented, comments in columns. Text in, text out.

Rows stay rows, comments and strings stay as they are, a row that cannot be read too. What a row says never
changes: a row whose tokens would be others is left alone.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.nodes.commands import Simple
from desire_tui.engine.nodes.segment import Event, Every
from desire_tui.engine.source import Source
from desire_tui.engine.structure.blocks import MISMATCHES
from desire_tui.engine.structure.structure import structure
from desire_tui.engine.syntax.logical_lines import is_header, logical_lines, numbered
from desire_tui.engine.syntax.parse import parse
from desire_tui.engine.syntax.statement_tokens import CLASSES, RAW, STRING, TokenFault
from desire_tui.engine.syntax.tokens import mark_logical_words, scan
from desire_tui.language.spacing import blanks_before

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from desire_tui.engine.nodes.program import Placed
    from desire_tui.engine.syntax.statement_tokens import LogicalLine

WIDTH = 2
"""Blanks a level."""
BLANKS = " \t\r\f\v\x1a"
"""What the tokenizer takes for a blank within a row; other characters, visible or not, are the author's."""
BLANK_ROWS_MAX = 2
"""So many blank rows may follow each other."""
_JOINT = re.compile(r"_[ \t\r]*\n")


class _Line(NamedTuple):
    """The rows of a line; `level` None: nobody knows how deep it stands."""

    text: str
    level: int | None
    is_readable: bool


@dataclass
class _Row:
    """A row, or all rows of a statement that goes on in others: `code` and the comment behind it."""

    code: str
    comment: str = ""
    column: int = 0
    """Where the author put the comment."""
    was_near: bool = False
    """One blank or none before it: it is in no column."""


class LaidOut(NamedTuple):
    """Some rows of a text (from 0), and the rows that take their place; None: they go."""

    rows: range
    text: str | None


def formatted(text: str) -> str:
    """Return a program in the usual layout. Never raises; a text in that layout is returned as it is."""
    row_end = "\r\n" if "\r\n" in text else "\n"
    kept = [part.text for part in layout(text) if part.text is not None]
    whole = "".join(line + row_end for part in kept for line in part.split("\n"))
    return whole if ends_whole(text) else whole.removesuffix(row_end)


def ends_whole(text: str) -> bool:
    """Whether a row end may follow a text: behind a last `_` it would join the next row."""
    return text.endswith("\n") or not text.rstrip(BLANKS).endswith("_")


def layout(text: str) -> list[LaidOut]:
    """Return the rows of a program in order, each line (with those that go on in it) in the usual layout."""
    source = Source(text.removesuffix("\n"))
    rows = [_laid_out(line) for line in _lines(source)]
    _align(rows)
    found: list[LaidOut] = []
    at = 0
    blank = BLANK_ROWS_MAX  # none at the beginning
    for row in rows:
        line = row.code + (" " * (row.column - len(row.code)) + row.comment if row.comment else "")
        blank = 0 if line else blank + 1
        here = range(at, at + row.code.count("\n") + 1)
        found.append(LaidOut(here, line.replace("\r", "") if blank <= BLANK_ROWS_MAX else None))
        at = here.stop
    last = len(found)
    while last and not found[last - 1].text:
        last -= 1
    return [*found[:last], *(LaidOut(part.rows, None) for part in found[last:])]


# ------------------------------------------------------------------------------------------ levels


def _lines(source: Source) -> Iterator[_Line]:
    """Yield the lines of a program in order."""
    lines = source.text.split("\n")
    joined = {rows.start: (entry, at, rows) for entry, at, _, rows in logical_lines(source.text)}
    opening, closing, known = _blocks(source)
    depth = row = 0
    while row < len(lines):
        level = depth if known else None
        if row not in joined:
            yield _Line(lines[row], level, is_readable=False)
            row += 1
            continue
        entry, at, rows = joined[row]
        text = "\n".join(lines[row : rows.stop])
        row = rows.stop
        starts = _statement_starts(text, at - source.line_starts[rows.start], source.line_starts[rows.start])
        leading = 0
        for start in starts:
            if start not in closing:
                break
            leading += 1
            if start in opening:  # `else`
                break
        is_readable = bool(entry[0]) and not any(isinstance(item, TokenFault) for item, _ in entry[0])
        yield _Line(text, max(depth - leading, 0) if known else None, is_readable)
        depth += sum((start in opening) - (start in closing) for start in starts)
        depth = max(depth, 0)


def _statement_starts(text: str, skipped: int, at: int) -> list[int]:
    return [at + skipped + chunk.base for chunk in scan(text[skipped:]).chunks]


def _blocks(source: Source) -> tuple[set[int], set[int], bool]:
    """Return the offsets of statements that open blocks, and close them; whether all is in order."""
    program = parse(source)
    found = structure(program)
    if any(problem.key in MISMATCHES for problem in found.problems) or program.unreadable:
        return set(), set(), False
    pairs: list[tuple[int, int]] = _pairs(found.partner, program.script)
    for segment in program.segments:
        pairs += _pairs(found.segment_partner.get(segment.label, {}), segment.body)
        pairs += _moments(segment.body)
    return {opens for opens, _ in pairs}, {closes for _, closes in pairs}, True


def _pairs(partner: dict[int, int], statements: tuple[Placed, ...]) -> list[tuple[int, int]]:
    forward = ((a, b) for a, b in partner.items() if a < b < len(statements))
    return [(statements[a].at, statements[b].at) for a, b in forward]


def _moments(body: Iterable[Placed]) -> Iterator[tuple[int, int]]:
    """Yield where blocks of `event` and `every` begin and end."""
    begun: int | None = None
    for placed in body:
        if isinstance(placed.node, Event | Every):
            begun = placed.at
        elif isinstance(placed.node, Simple) and placed.node.word == "end event" and begun is not None:
            yield begun, placed.at
            begun = None


# -------------------------------------------------------------------------------------------- rows


def _laid_out(here: _Line) -> _Row:
    """Return a line in the usual layout."""
    text, level, is_readable = here
    bare = text.rstrip(BLANKS)
    if is_header(text) or _JOINT.search(text) or bare.endswith("_"):
        return _Row(text if "\n" in text else bare)  # `_` joins what stands at the rows' ends and beginnings
    skipped = numbered(text)
    number, line = text[:skipped].strip(BLANKS), text[skipped:]
    scanned = scan(line)
    if not is_readable:
        return _unread(number, line, scanned, level)
    code = _code(line, scanned)
    if not _says_the_same(scanned, code):
        code = line[: _code_end(scanned)].strip(BLANKS)
    own = _margin(line)[1 if number else 0 :]  # behind a number one blank is no margin
    margin = own if level is None else " " * (WIDTH * level)
    head = f"{number} " if number else ""
    whole = head + margin + _shifted(code, len(margin) - len(own))
    if not scanned.comments or scanned.comments[-1][0] < _code_end(scanned):
        return _Row(whole)
    start, end = scanned.comments[-1]
    last = text.rfind("\n", 0, skipped + start) + 1
    gap = line[_code_end(scanned) : start]
    return _Row(whole, line[start:end].rstrip(BLANKS), skipped + start - last, len(gap.expandtabs()) < 2)


def _unread(number: str, line: str, scanned: LogicalLine, level: int | None) -> _Row:
    """Return a row without statements, or one that cannot be read: a comment moves with its block."""
    bare = line.rstrip(BLANKS)
    head = f"{number} " if number else ""
    if not bare:
        return _Row(number)
    if scanned.chunks or level is None or not bare.lstrip(BLANKS).startswith("--") or bare.startswith("--"):
        return _Row(head + bare if not number else f"{number}{bare}")
    return _Row(head + " " * (WIDTH * level) + bare.lstrip(BLANKS))


def _margin(line: str) -> str:
    return line[: len(line) - len(line.lstrip(" \t"))]


def _shifted(code: str, by: int) -> str:
    """Move the rows behind the first with it."""
    first, *others = code.split("\n")
    moved = []
    for row in others:
        margin = len(_margin(row).expandtabs())
        moved.append(" " * max(margin + by, 0) + row.lstrip(" \t"))
    return "\n".join((first, *moved))


def _code_end(scanned: LogicalLine) -> int:
    last = scanned.chunks[-1]
    return last.base + last.ends[-1]


def _code(line: str, scanned: LogicalLine) -> str:
    """Return the statements of a line with the usual blanks; row ends stay where they are."""
    pieces: list[str] = []
    end: int | None = None
    for chunk in scanned.chunks:
        mark_logical_words(chunk)
        gaps = [
            line[chunk.base + a : chunk.base + b]
            for a, b in zip([0, *chunk.ends], chunk.starts, strict=False)
        ]
        for place, blank in enumerate(blanks_before(chunk, gaps)):
            start = chunk.base + chunk.starts[place]
            gap = "" if end is None else line[end:start]
            if "\n" in gap:
                pieces.append(_row_ends(gap))
            elif place == 0 and end is not None:
                pieces.append(" | " if "|" in gap else " ")
            else:
                pieces.append(blank)
            end = chunk.base + chunk.ends[place]
            pieces.append(_written(line[start:end], chunk.kinds[place]))
    return "".join(pieces)


def _written(token: str, kind: str) -> str:
    """Return a token as it is written: `end  while` with one blank, a typographic minus as a plain one."""
    if kind in {STRING, RAW}:
        return token
    return " ".join(token.split()) if kind in CLASSES or kind[0].isalpha() else kind


def _row_ends(gap: str) -> str:
    """Return the row ends between two tokens, with the comments there and the blanks before the second."""
    rows = gap.split("\n")
    first = rows[0].strip(BLANKS)
    middle = [row.rstrip(BLANKS) for row in rows[1:-1]]
    return "\n".join((f" {first}" if first else "", *middle, rows[-1]))


def _says_the_same(scanned: LogicalLine, code: str) -> bool:
    again = scan(code)
    for chunk in again.chunks:
        mark_logical_words(chunk)
    old = [(chunk.kinds, chunk.texts) for chunk in scanned.chunks]
    return old == [(chunk.kinds, chunk.texts) for chunk in again.chunks] and all(
        chunk.fault is None for chunk in again.chunks
    )


# ---------------------------------------------------------------------------------------- comments


def _align(rows: list[_Row]) -> None:
    """Put comments behind code into columns: neighbours that had one keep it, further right if they must."""
    place = 0
    while place < len(rows):
        last = place + 1
        row = rows[place]
        if row.comment:
            while last < len(rows) and rows[last].comment and rows[last].column == row.column:
                last += 1
            _align_group(rows[place:last])
        place = last


def _align_group(group: list[_Row]) -> None:
    longest = max(len(row.code.rpartition("\n")[2]) for row in group)
    column = group[0].column
    if len(group) == 1 and group[0].was_near:
        column = longest + 1
    elif column <= longest:
        column = longest + 2
    for row in group:
        # `column` counts in the last row of a statement that goes on
        row.column = column + len(row.code) - len(row.code.rpartition("\n")[2])
