"""The lines of an `.ode` file as XPPAUT sees them: joined, included, array lines written out.

`x[1..3]'=-x[j]` stands for three lines with 1, 2, 3 in the place of the range and of `[j]`, `x[j-1]` for the
neighbour; `%[1..3]` repeats all lines up to the next `%`.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

from desire_tui.convert.problem import placed
from desire_tui.engine.data_classes import dataclass, replace
from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.files import read_source
from desire_tui.engine.source import Source, Span

if TYPE_CHECKING:
    from collections.abc import Iterator
    from typing import Literal

    from desire_tui.engine.diagnostics import Diagnostic

_RANGE = re.compile(r"\[\s*(-?\d+)\s*\.\.\s*(-?\d+)\s*\]")
_INDEX = re.compile(r"\[\s*j\s*(?:([-+*])\s*(\d+)\s*)?\]", re.IGNORECASE)
"""`[j]`, `[j+1]`."""
_PLACE = re.compile(r"\[\s*(\d+)\s*\]")
"""`x[3]` is x3 wherever it stands."""
_BLOCK = re.compile(r"%\s*\[\s*(-?\d+)\s*\.\.\s*(-?\d+)\s*\]\s*\Z")
_INCLUDE = re.compile(r"#include\s+(\S+)")
_DONE = re.compile(r"d(?:one)?\s*\Z", re.IGNORECASE)
ELEMENTS_MOST = 20_000
"""How many lines an array may be written out to."""
INCLUDED_MOST = 20
"""How deep files may include each other."""


@dataclass(frozen=True)
class Line:
    """A line that declares something: its text, its place in the file, the comment above it."""

    text: str
    source: Source
    span: Span
    comment: str = ""
    written_out: bool = False
    """It is one of the lines that a line with a range stands for."""

    def problem(self, key: Literal["convert-part", "convert-note"], what: str, reason: str) -> Diagnostic:
        """Return a problem at this place."""
        return placed(self.source, self.span, key, what, reason)


def logical_lines(source: Source, problems: list[Diagnostic]) -> list[Line]:
    """Return the file's lines up to `done`, with those that it includes; what is wrong goes to `problems`."""
    lines: list[Line] = []
    _read(source, lines, problems, depth=0)
    return [line for block in _written_out(lines, problems) for line in _elements(block, problems)]


def _read(source: Source, lines: list[Line], problems: list[Diagnostic], *, depth: int) -> bool:
    """Append a file's lines; True: it said `done`."""
    comment: list[str] = []
    for text, span in _joined(source):
        if text.startswith(("#", '"')):
            include = _INCLUDE.match(text)
            if include is None:
                comment.append(text.lstrip('#"').strip())
            elif _include(Line(text, source, span), include[1], lines, problems, depth):
                return True
        elif _DONE.match(text):
            return True
        elif text:
            lines.append(Line(text, source, span, "\n".join(comment).strip()))
            comment = []
        elif comment and not lines:
            comment.append("")  # the comment at the top of the file ends at a blank line
    return False


def _joined(source: Source) -> Iterator[tuple[str, Span]]:
    r"""Yield lines without blanks around them, those that end in `\` joined with the next."""
    parts: list[str] = []
    start = end = 0
    for row, begin in enumerate(source.line_starts, 1):
        text = source.line(row)
        if not parts:
            start = begin + len(text) - len(text.lstrip())
            end = max(start, begin + len(text.rstrip()))
        stripped = text.rstrip()
        if stripped.endswith("\\"):
            parts.append(stripped[:-1])
            continue
        yield "".join([*parts, stripped]).strip(), Span(start, end)
        parts = []
    if parts:
        yield "".join(parts).strip(), Span(start, end)


def _include(line: Line, name: str, lines: list[Line], problems: list[Diagnostic], depth: int) -> bool:
    folder = line.source.path.parent if line.source.path is not None else Path()
    if depth >= INCLUDED_MOST:
        problems.append(line.problem("convert-part", what=line.text, reason="files include each other"))
        return False
    try:
        included = read_source(folder / name)
    except DesireError as error:
        reason = error.diagnostics[0].message
        problems.append(line.problem("convert-part", what=line.text, reason=reason))
        return False
    return _read(included, lines, problems, depth=depth + 1)


def _written_out(lines: list[Line], problems: list[Diagnostic]) -> Iterator[list[Line]]:
    """Yield lines one by one, those of a `%` block for each of its numbers."""
    block: list[Line] = []
    opened: Line | None = None
    bounds = range(0)
    for line in lines:
        begins = _BLOCK.match(line.text)
        if begins is None and line.text.strip() != "%":
            if opened is None:
                yield [line]
            else:
                block.append(line)
            continue
        for number in bounds:
            yield [_at(one, number) for one in block]
        block, opened, bounds = [], None, range(0)
        if begins is not None:
            opened, bounds = line, _range(begins[1], begins[2])
            if len(bounds) > ELEMENTS_MOST:
                problems.append(line.problem("convert-part", what=line.text, reason=_too_many(bounds)))
                bounds = range(0)
    if opened is not None:
        problems.append(opened.problem("convert-part", what=opened.text, reason="no % ends the block"))


def _elements(lines: list[Line], problems: list[Diagnostic]) -> Iterator[Line]:
    """Yield lines with ranges once for each number of the (first) range."""
    for line in lines:
        found = _RANGE.search(line.text)
        if found is None:
            yield replace(line, text=_PLACE.sub(r"\1", line.text))
            continue
        bounds = _range(found[1], found[2])
        if len(bounds) > ELEMENTS_MOST:
            problems.append(line.problem("convert-part", what=line.text, reason=_too_many(bounds)))
            continue
        for count, number in enumerate(bounds):
            text = _PLACE.sub(r"\1", _RANGE.sub(str(number), line.text))
            yield _at(
                replace(line, text=text, comment=line.comment if count == 0 else "", written_out=True), number
            )


def _range(first: str, last: str) -> range:
    low, high = int(first), int(last)
    return range(low, high + 1) if low <= high else range(low, high - 1, -1)


def _too_many(bounds: range) -> str:
    return f"it stands for {len(bounds)} lines, more than {ELEMENTS_MOST}"


def _at(line: Line, number: int) -> Line:
    """Return the line with a number in the place of the index."""

    def value(found: re.Match[str]) -> str:
        by = int(found[2] or 0)
        match found[1]:
            case "+":
                return str(number + by)
            case "-":
                return str(number - by)
            case "*":
                return str(number * by)
            case _:
                return str(number)

    return replace(line, text=_INDEX.sub(value, line.text))
