"""Data files whose first line names their columns: CSV, with tabs, semicolons and decimal commas too."""

from __future__ import annotations

import csv
import re
from math import isfinite
from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import DesireError, Diagnostic, closest
from desire_tui.engine.library import LIBRARY

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

_SEPARATORS = ("\t", ";", ",")
_LABEL = re.compile(r"[^\W\d][^*^+=]*")
_CALL = re.compile(r"(\w+)\s*\(")
_UNIT = re.compile(r"\s*(\(.*\)|\[.*\]|/.*)$")
_NOT_IN_NAMES = re.compile(r"\W+")
_NAMES_SHOWN = 8
_ROWS_UNCHECKED = 1000


class DataTable:
    """The columns of a file: their names and what stands between them (None: blanks)."""

    def __init__(self, names: Sequence[str], separator: str | None) -> None:
        self.names, self._separator = names, separator
        self._place: dict[str, int] = {}
        for form in (str, plain_name, _folded):
            for place, name in enumerate(names):
                self._place.setdefault(form(name), place)

    def find(self, name: str) -> int | None:
        """Return the place of a column: its name as it is, without a unit, without regard to capitals."""
        place = self._place.get(name)
        return self._place.get(name.casefold()) if place is None else place

    def others(self, name: str) -> dict[str, object]:
        """Return what a message says about a column that is not there."""
        shown = ", ".join(filter(None, self.names[:_NAMES_SHOWN]))
        more = " …" if len(self.names) > _NAMES_SHOWN else ""
        return {"name": name, "columns": shown + more, "close": closest(name, map(plain_name, self.names))}

    def columns(
        self, lines: Iterable[tuple[int, str]], wanted: Sequence[int], file: str, check: Callable[[], object]
    ) -> list[list[float]]:
        """Return the numbers of some columns. DesireError 18: a cell holds none."""
        found: list[list[float]] = [[] for _ in wanted]
        for count, (number, line) in enumerate(lines, 1):
            cells = cells_of(line, self._separator)
            for place, column in zip(wanted, found, strict=True):
                text = cells[place].strip() if place < len(cells) else ""
                value = number_in(text)
                if value is None:
                    facts = {"line": number, "file": file, "column": self.names[place], "entry": text}
                    raise DesireError(Diagnostic("cell-not-a-number", facts=facts))
                column.append(value)
            if count % _ROWS_UNCHECKED == 0:
                check()
        return found


def separator_of(line: str) -> str | None:
    """Return what stands between the names in a file's first line; None: blanks, or there is one name."""
    return next((separator for separator in _SEPARATORS if separator in line), None)


def column_names(line: str, is_value: Callable[[str], bool] | None) -> list[str] | None:
    """Return the names of columns that a line holds; None: it holds numbers or expressions.

    `is_value`: whether a name has a value; a line where all have is one of values. None: such a line names
    columns nevertheless.
    """
    separator = separator_of(line)
    names = [name.strip() for name in cells_of(line, separator)]
    if separator is None:
        names = [name for name in names if name[0] not in "(["]  # units
    given = [name for name in names if name]
    if not given or not all(map(_is_label, given)):
        return None
    if is_value is not None and all(is_value(name) for name in given):
        return None
    return names


def begins_with_number(line: str) -> bool:
    """Whether a line begins with a number, as those below the names of columns do."""
    cells = cells_of(line, separator_of(line))
    return bool(cells) and number_in(cells[0]) is not None


def _is_label(text: str) -> bool:
    if number_in(text) is not None or _LABEL.fullmatch(text) is None:
        return False
    call = _CALL.match(text)
    return call is None or call[1] not in LIBRARY


def cells_of(line: str, separator: str | None) -> list[str]:
    """Return what stands between the separators of a line, or between its blanks."""
    if separator is None:
        return line.replace('"', "").split()
    try:
        return next(csv.reader([line], delimiter=separator, skipinitialspace=True), [])
    except csv.Error:  # a cell longer than the library takes
        return line.split(separator)


def plain_name(name: str) -> str:
    """Return what a column's name is as one of the language: `Temp. (°C)` is `Temp`, `x pos` is `x_pos`."""
    return _NOT_IN_NAMES.sub("_", without_unit(name)).strip("_")


def without_unit(name: str) -> str:
    """Return a column's name without the unit that stands behind it."""
    return _UNIT.sub("", name)


def _folded(name: str) -> str:
    return plain_name(name).casefold()


def number_in(text: str) -> float | None:
    """Return a finite number, its decimal sign a point or a comma."""
    try:
        value = float(text.replace(",", ".", 1))
    except ValueError:
        return None
    return value if isfinite(value) else None
