"""Tables: `table w % 11 -5 5 exp(-abs(t))` and `table w file.tab`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from desire_tui.convert.model import Table
from desire_tui.convert.xppaut.constants import constant
from desire_tui.convert.xppaut.expression_parser import parsed
from desire_tui.convert.xppaut.vocabulary import NotConvertibleError
from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.files import read_source

if TYPE_CHECKING:
    from desire_tui.convert.xppaut.building import Building
    from desire_tui.convert.xppaut.declarations import Declaration

POINTS_MOST = 100_000


def table(one: Declaration, building: Building) -> Table:
    """Return the table that a line declares. NotConvertibleError."""
    words = one.right.split(None, 1)
    if len(words) < 2:
        raise NotConvertibleError("a table is `table name file` or `table name % n low high formula`")
    name, rest = building.spelling[words[0].lower()], words[1].strip()
    if not rest.startswith("%"):
        return _from_file(name, rest, one)
    parts = rest[1:].split(None, 3)
    if len(parts) != 4:
        raise NotConvertibleError("a table is `table name % n low high formula`")
    constants = dict(building.places.constants)
    count, low, high = (constant(parsed(_signed(part)), constants) for part in parts[:3])
    xs = _even(int(count), low, high)
    return Table(name, xs, formula=building.formula(parts[3], one.line), comment=one.line.comment)


def _signed(text: str) -> str:
    return text.removeprefix("+")


def _even(count: int, low: float, high: float) -> list[float]:
    if not 2 <= count <= POINTS_MOST or not low < high:
        raise NotConvertibleError(f"a table has 2 to {POINTS_MOST} points over a rising range")
    return [low + (high - low) * k / (count - 1) for k in range(count)]


def _from_file(name: str, file: str, one: Declaration) -> Table:
    """Return the table of a file: how many points, from where, to where, the values."""
    folder = one.line.source.path.parent if one.line.source.path is not None else Path()
    try:
        text = read_source(folder / file).text
    except DesireError as error:
        raise NotConvertibleError(error.diagnostics[0].message) from None
    try:
        count, low, high, *ys = (float(word) for word in text.split())
    except ValueError:
        raise NotConvertibleError(f"{file} does not hold a number of points, a range and values") from None
    if len(ys) < count:
        raise NotConvertibleError(f"{file} should hold {int(count)} values, there are {len(ys)}")
    return Table(name, _even(int(count), low, high), ys[: int(count)], comment=one.line.comment)
