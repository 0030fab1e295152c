"""A file of measurements as a whole: columns of numbers by name, every problem told with its row and column.

CSV with tabs, semicolons or commas, decimal commas, `#` comments, blanks for what is missing, units behind
names or on a line of their own; Excel files through pandas.
"""

from __future__ import annotations

import re
from io import BytesIO
from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.data_classes import dataclass, field
from desire_tui.engine.data_files.data_table import (
    cells_of,
    column_names,
    number_in,
    plain_name,
    separator_of,
    without_unit,
)
from desire_tui.engine.diagnostics import DesireError, Diagnostic, closest
from desire_tui.engine.files import PROGRAM_BYTES_MAX, decoded, read_source
from desire_tui.engine.program_files import open_for_program
from desire_tui.engine.source import Source, Span

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping
    from pathlib import Path

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

_MISSING = frozenset(("", "na", "n/a", "nan", "null", "none", "-", "--", ".", "?", "#n/a"))
_SETTING = re.compile(r"#\s*([A-Za-z][\w$]*(?:\[[\d,\s]+\])?)\s*=\s*([+-]?[\d.]+(?:[eE][+-]?\d+)?)\s*$")
_UNIT = re.compile(r"[(\[].*[)\]]|[^\d\s]*")
EXCEL_ENDINGS = (".xlsx", ".xls", ".xlsm", ".ods")
_PROBLEMS_MOST = 20


@dataclass(frozen=True)
class DataFile:
    """What a file holds: `columns` by plain names, nan where nothing was measured.

    `settings`: what comments like `# k = 3` say was different; `notes`: what was not taken as it stands.
    """

    name: str
    columns: dict[str, Floats]
    settings: dict[str, float] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    @property
    def time(self) -> str:
        """The column that holds the time: `t`, `time`, else the first."""
        return time_column(self.columns)

    def measured(self, column: str, *others: str) -> tuple[Floats, ...]:
        """Return the times at which columns (by their plain names) have values, rising, and these values."""
        rows = np.array([self.columns[name] for name in (self.time, column, *others)])
        rows = rows[:, np.isfinite(rows).all(axis=0)]
        return tuple(rows[:, np.argsort(rows[0], kind="stable")])

    def find(self, name: str) -> str | None:
        """Return a column's name, found without regard to capitals too."""
        folded = {known.casefold(): known for known in reversed(self.columns)}
        return name if name in self.columns else folded.get(name.casefold())

    def near(self, name: str) -> str | None:
        """Return the column that might have been meant."""
        return closest(name, self.columns)


def time_column(names: Iterable[str]) -> str:
    """Return which of a file's columns holds the time: `t`, `time`, else the first."""
    given = list(names)
    return next((name for name in given if name.casefold() in {"t", "time"}), given[0])


def first_line_names(head: str) -> tuple[list[str], list[str]] | None:
    """Return the names in the line of names as they are and without units; None: it holds none."""
    given = column_names(head, None)
    if given is None:
        return None
    return given, [plain_name(name) or f"column{place}" for place, name in enumerate(given, 1)]


def read_data_file(path: Path) -> DataFile:
    """Read a file. DesireError 38: it cannot be read; 531 … 533: everything that is wrong in it."""
    if path.suffix.lower() in EXCEL_ENDINGS:
        return _Reader(Source(_text_of_excel(path, path), str(path))).read()
    return _Reader(read_source(path)).read()


def read_program_data(path: Path) -> DataFile:
    """Read a file that a program names, by its resolved path, which it was permitted to read.

    DesireError 38: there is none, or it is no text; 18: it cannot be read, 531 … 534 as `read_data_file`.
    """
    try:
        with open_for_program(path, "rb") as file:
            data: bytes = file.read(PROGRAM_BYTES_MAX + 1)
    except FileNotFoundError:
        raise DesireError(Diagnostic("measurements-missing", facts={"file": path})) from None
    except (OSError, ValueError) as problem:
        facts = {"file": path, "reason": getattr(problem, "strerror", None) or problem}
        raise DesireError(Diagnostic("cannot-read", facts=facts)) from None
    if len(data) > PROGRAM_BYTES_MAX:
        raise DesireError(Diagnostic("cannot-read", facts={"file": path, "reason": "it is too long"}))
    if path.suffix.lower() in EXCEL_ENDINGS:
        return _Reader(Source(_text_of_excel(path, BytesIO(data)), str(path))).read()
    return _Reader(Source(decoded(data, str(path)), str(path), path)).read()


class _Reader:
    def __init__(self, source: Source) -> None:
        self._source = source
        self._problems: list[Diagnostic] = []
        self._settings: dict[str, float] = {}

    def read(self) -> DataFile:
        lines = list(self._lines())
        if not lines:
            self._problem("data-empty", Span(0, 0), {"what": "it is empty"})
            raise DesireError(*self._problems)
        start, head = lines[0]
        found = first_line_names(head)
        separator = separator_of(head)
        if found is None:
            what = "its first line holds no names of columns"
            self._problem("data-empty", Span(start, start + len(head)), {"what": what})
            raise DesireError(*self._problems)
        given, names = found
        notes = []
        others = [(name, short) for name, short in zip(given, names, strict=True) if name not in {"", short}]
        if others:
            said = f"{self._source.file_name}: {', '.join(f'{name} is {short}' for name, short in others)}"
            units = any(without_unit(name) != name for name, _ in others)
            notes.append(f"{said}: units are not converted" if units else said)
        rows = lines[1:]
        if rows and self._holds_units(rows[0][1], separator):
            notes.append(f"{self._source.file_name}: the line of units '{rows[0][1].strip()}' is left out")
            rows = rows[1:]
        if not rows:
            self._problem(
                "data-empty", Span(start, start + len(head)), {"what": "no numbers stand below the names"}
            )
        table = self._table(rows, names, separator)
        for name in {name for name in names if names.count(name) > 1}:
            self._problem(
                "data-empty", Span(start, start + len(head)), {"what": f"two columns are called {name}"}
            )
        if self._problems:
            raise DesireError(*self._problems[:_PROBLEMS_MOST])
        columns = {name: table[:, place].copy() for place, name in enumerate(names)}
        return DataFile(self._source.file_name, columns, self._settings, tuple(notes))

    def _lines(self) -> Iterator[tuple[int, str]]:
        """Yield the lines that hold something, each with its place; note what comments set."""
        start = 0
        for line in self._source.text.split("\n"):
            stripped = line.strip()
            if stripped.startswith("#"):
                found = _SETTING.match(stripped)
                if found is not None:
                    self._settings[found[1].replace(" ", "")] = float(found[2])
            elif stripped:
                yield start, line.rstrip("\r")
            start += len(line) + 1

    def _holds_units(self, line: str, separator: str | None) -> bool:
        """Whether a line below the names holds units: no numbers, nothing that stands for a missing one."""
        given = [cell.strip() for cell in cells_of(line, separator)]
        if not any(given) or any(number_in(cell) is not None for cell in given):
            return False
        return all(_UNIT.fullmatch(cell) for cell in given) and not all(
            c.casefold() in _MISSING for c in given
        )

    def _table(self, rows: list[tuple[int, str]], names: list[str], separator: str | None) -> Floats:
        table = np.full((len(rows), len(names)), np.nan)
        for row, (start, line) in enumerate(rows):
            given = cells_of(line, separator)
            if len(given) > len(names) and not any(cell.strip() for cell in given[len(names) :]):
                given = given[: len(names)]
            if len(given) != len(names):
                facts: dict[str, object] = {"have": len(given), "want": len(names)}
                self._problem("data-ragged", Span(start, start + len(line)), facts)
                continue
            at = start
            for place, cell in enumerate(given):
                text = cell.strip()
                at = max(self._source.text.find(text, at, start + len(line)), at) if text else at
                value = number_in(text)
                if value is not None:
                    table[row, place] = value
                elif text.casefold() not in _MISSING:
                    facts = {"column": names[place], "entry": text}
                    self._problem("data-cell", Span(at, at + len(text)), facts)
                at += len(text)
        return table

    def _problem(self, key: str, span: Span, facts: Mapping[str, object]) -> None:
        given = {**facts, "file": self._source.file_name}
        self._problems.append(Diagnostic(key, span, given, self._source))


def _text_of_excel(path: Path, file: Path | BytesIO) -> str:
    """Return an Excel file's first sheet as text with tabs. DesireError 534: pandas is missing; 38."""
    try:
        import pandas as pd

        sheet = pd.read_excel(file, header=None, dtype=object)
    except ImportError as reason:
        facts = {"file": path.name, "library": reason.name or "pandas"}
        raise DesireError(Diagnostic("data-library", None, facts)) from None
    except FileNotFoundError:
        raise DesireError(Diagnostic("program-missing", facts={"path": path})) from None
    except (OSError, ValueError) as problem:
        raise DesireError(Diagnostic("file-unreadable", facts={"path": path, "reason": problem})) from None
    text: str = sheet.to_csv(sep="\t", header=False, index=False)
    return text
