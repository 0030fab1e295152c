"""Values given from outside (`--set`, `desire_tui.run(set=…)`) as settings for `session.overrides`."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING, Any

from desire_tui.engine.session.overrides import name_and_subscripts

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping


def from_texts(texts: Iterable[str]) -> dict[str, float]:
    """Read `a=3`, `a[2]=3`, `v=1,2,3` (a vector's first elements), `A=1,2;3,4` (a matrix, row by row).

    ValueError: the text has none of these forms. A later setting of the same name or element wins.
    """
    settings: dict[str, float] = {}
    for text in texts:
        name, equals, value = text.partition("=")
        if not equals:
            raise ValueError(text)
        rows = [[_number(number, text) for number in row.split(",")] for row in value.split(";")]
        try:
            settings.update(_elements(name, rows))
        except ValueError:
            raise ValueError(text) from None
    return settings


def from_mapping(values: Mapping[str, Any]) -> dict[str, float]:
    """Return settings of names whose values are numbers, lists or arrays. ValueError: of something else."""
    import numpy as np

    settings: dict[str, float] = {}
    for name, value in values.items():
        numbers = np.asarray(value, dtype=np.float64)
        if not np.isfinite(numbers).all():
            raise ValueError(f"{name} cannot be {value!r}")
        if numbers.ndim == 0:
            settings.update(_elements(name, [[float(numbers)]]))
            continue
        own, subscripts = name_and_subscripts(name)
        if subscripts:
            raise ValueError(f"{name} is one element, but {value!r} are several")
        for place, number in np.ndenumerate(numbers):
            settings[f"{own}[{','.join(str(i + 1) for i in place)}]"] = float(number)
    return settings


def _elements(name: str, rows: list[list[float]]) -> dict[str, float]:
    own, subscripts = name_and_subscripts(name)
    first = f"{own}[{','.join(map(str, subscripts))}]" if subscripts else own
    if len(rows) == 1 and len(rows[0]) == 1:
        return {first: rows[0][0]}
    if subscripts:
        raise ValueError(name)
    if len(rows) == 1:
        return {f"{own}[{i}]": number for i, number in enumerate(rows[0], 1)}
    return {f"{own}[{i},{k}]": number for i, row in enumerate(rows, 1) for k, number in enumerate(row, 1)}


def _number(text: str, whole: str) -> float:
    try:
        number = float(text)
    except ValueError:
        raise ValueError(whole) from None
    if not isfinite(number):
        raise ValueError(whole)
    return number
