"""What varies, as users write it: `UC=0.2:0.3:101`, `k=normal(40,4), r=…`, a CSV file; arrays and dicts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from desire_tui.engine.data_files.data_table import cells_of, number_in, separator_of
from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.files import read_source
from desire_tui.studies.distributions import EXAMPLE as DRAWN
from desire_tui.studies.distributions import Distribution, distribution, read
from desire_tui.studies.texts import Piece, name_and_rest, number, split, whole

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping
    from pathlib import Path

    from numpy.typing import NDArray

    from desire_tui.engine.source import Source

    Floats = NDArray[np.float64]

EXAMPLE = "UC=0.2:0.3:101 (from, to, how many), k=1:1000:4:log, lead=0,5,10"
POINTS = "names, then a line of numbers for each run: k,x0"
COUNT_MOST = 10_000_000
"""Values of one quantity of a grid: they are kept in memory, and told in the result."""


def over_texts(texts: Iterable[str]) -> dict[str, Floats]:
    """Read `UC=0.2:0.3:101`, `lead=0,5,10`, one quantity each. DesireError 510, 511."""
    found: dict[str, Floats] = {}
    for text in texts:
        piece = whole(text, "--over")
        name, rest = name_and_rest(piece, EXAMPLE)
        if name in found:
            raise DesireError(Diagnostic("study-twice", None, {"name": name}))
        found[name] = values(rest)
    return found


def values(piece: Piece) -> Floats:
    """Read `0.2:0.3:101`, `1:1000:4:log`, `0,5,10`. DesireError 510, 511."""
    parts = list(split(piece, ":"))
    if len(parts) == 1:
        return np.array([number(part, EXAMPLE) for part in split(piece)])
    is_log = len(parts) == 4 and parts[3].text == "log"
    if len(parts) != 3 and not is_log:
        raise piece.wrong(f"'{piece.text}' names no values", f"from:to:count, for instance {EXAMPLE}")
    first, last, count = number(parts[0], EXAMPLE), number(parts[1], EXAMPLE), number(parts[2], EXAMPLE)
    if count > COUNT_MOST:
        raise parts[2].wrong(f"{count:g} values are more than {COUNT_MOST:,}", "take fewer, or draw them")
    if count != int(count) or count < 0:
        raise parts[2].wrong(f"{count:g} is no number of values", f"from:to:count, for instance {EXAMPLE}")
    if count == 0:
        facts = {"what": f"'{piece.text}' has no values", "remedy": "a count of 1 or more"}
        raise DesireError(Diagnostic("study-empty", None, facts))
    if is_log:
        if not (first > 0.0 and last > 0.0):
            raise piece.wrong("a logarithmic scale has no 0 and nothing below", "from and to above 0")
        return np.geomspace(first, last, int(count))
    return np.linspace(first, last, int(count))


def sample_texts(texts: Iterable[str]) -> dict[str, Distribution]:
    """Read `k=normal(40,4), r=lognormal(0,0.2)`. DesireError 510."""
    found: dict[str, Distribution] = {}
    for text in texts:
        for piece in split(whole(text, "--sample")):
            name, rest = name_and_rest(piece, DRAWN)
            if name in found:
                raise DesireError(Diagnostic("study-twice", None, {"name": name}))
            found[name] = read(rest)
    return found


def over_mapping(given: Mapping[str, Any]) -> dict[str, Floats]:
    """Return axes from numbers, lists, arrays or texts by names. ValueError: no finite numbers."""
    return {_name(name): _numbers(name, value) for name, value in given.items()}


def sample_mapping(given: Mapping[str, Any]) -> dict[str, Distribution]:
    """Return distributions from texts or frozen ones of scipy by names. DesireError 510."""
    return {_name(name): distribution(value, f"sample[{name!r}]") for name, value in given.items()}


def points_of(given: Any) -> dict[str, Floats]:
    """Return columns of a table: a file of comma-separated values, a DataFrame, lists by names."""
    if given is None:
        return {}
    if isinstance(given, str) or hasattr(given, "__fspath__"):
        from pathlib import Path

        return points_file(Path(given))
    if not hasattr(given, "keys"):
        raise TypeError(
            f"points is a CSV file's name, a DataFrame or a mapping of names to lists, not {given!r}"
        )
    return {_name(str(name)): _numbers(str(name), given[name]) for name in given}


def points_file(path: Path) -> dict[str, Floats]:
    """Read a file whose first line holds names, the others numbers. DesireError 38, 510, 511.

    Between them stand commas, semicolons or tabs; decimal signs are points or commas; `#` begins comments.
    """
    source = read_source(path)
    lines = list(_lines(source))
    if not lines:
        facts = {"what": f"{path} is empty", "remedy": "names, then numbers"}
        raise DesireError(Diagnostic("study-empty", None, facts))
    separator = separator_of(lines[0].text)
    names: list[str] = []
    for cell in _cells(lines[0], separator):
        if not cell.text:
            raise cell.wrong("a name is missing here", POINTS)
        name = name_and_rest(cell._replace(text=f"{cell.text}=0"), POINTS)[0]
        if name in names:
            raise cell.wrong(f"'{name}' is given twice", "leave one of its columns away")
        names.append(name)
    table = np.empty((len(lines) - 1, len(names)))
    for row, line in zip(table, lines[1:], strict=True):
        cells = _cells(line, separator)
        if len(cells) != len(names):
            told = f"{len(cells)} value{'s' * (len(cells) != 1)} in a line of {len(names)}"
            raise line.wrong(told, "one for each name in the first line")
        for place, cell in enumerate(cells):
            value = number_in(cell.text)
            if value is None:
                raise cell.wrong(
                    f"'{cell.text}' is no number" if cell.text else "a number is missing", POINTS
                )
            row[place] = value
    return {name: table[:, place].copy() for place, name in enumerate(names)}


def _lines(source: Source) -> Iterator[Piece]:
    """Yield the lines of a table, without blank ones and comments."""
    at = 0
    for line in source.text.split("\n"):
        if line.strip() and not line.lstrip().startswith("#"):
            yield Piece(line, at, source).part(0)
        at += len(line) + 1


def _cells(line: Piece, separator: str | None) -> list[Piece]:
    """Return what stands between separators, without quotes, each with its place."""
    found, at = [], 0
    for text in (cell.strip() for cell in cells_of(line.text, separator)):
        at = max(line.text.find(text, at), at)
        found.append(line._replace(text=text, at=line.at + at))
        at += len(text)
        at = max(line.text.find(separator, at) + 1, at) if separator else at
    return found


def _name(text: str) -> str:
    return name_and_rest(whole(f"{text}=0", "names"), "k, a[2]")[0]


def _numbers(name: str, value: Any) -> Floats:
    if isinstance(value, str):
        return values(whole(value, f"over[{name!r}]"))
    try:
        numbers = np.atleast_1d(np.asarray(value, dtype=np.float64))
    except (TypeError, ValueError):
        numbers = np.array([np.nan])
    if numbers.ndim != 1 or not np.isfinite(numbers).all():
        raise ValueError(f"{name} varies over finite numbers, a list of them or an array, not {value!r}")
    return numbers
