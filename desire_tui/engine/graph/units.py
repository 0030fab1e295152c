"""Units that a program names: `units 'x m, v m/s, t s'`."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

_COMMA = re.compile(r",(?![^\[]*\])")
"""One that is not between the subscripts of an element."""
_NAMED = re.compile(r"\s*([A-Za-z][\w$]*(?:\[[^\]]*\])?)\s*[:=]?\s*(\S.*?)\s*")


def units_of(text: str) -> dict[str, str]:
    """Return the units by the names of their quantities; what is no name with a unit says nothing."""
    found = (_NAMED.fullmatch(part) for part in _COMMA.split(text))
    return {pair[1]: pair[2] for pair in found if pair is not None}


def named_in(text: str) -> list[tuple[int, str]]:
    """Return the quantities of such a text with the offsets of their names, subscripts left out."""
    found, start = [], 0
    for part in _COMMA.split(text):
        if pair := _NAMED.fullmatch(part):
            found.append((start + pair.start(1), pair[1].partition("[")[0]))
        start += len(part) + 1
    return found


def with_units(names: str, units: Mapping[str, str]) -> str:
    """Return `x, y [m]` for names that share a unit, `x [m], v [m/s]` for others."""
    if not units:
        return names
    parts = [name.strip() for name in _COMMA.split(names)]
    known = [units.get(part, "") for part in parts]
    if len(set(known)) == 1:
        return f"{', '.join(parts)} [{known[0]}]" if known[0] else names
    return ", ".join(f"{part} [{unit}]" if unit else part for part, unit in zip(parts, known, strict=True))
