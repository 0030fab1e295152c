"""Global flags: `global 1 {condition} {x=…;y=…}` as events."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from desire_tui.convert.expressions import Expression, Name, Negative, Relation, number
from desire_tui.convert.model import Event, Quantity

if TYPE_CHECKING:
    from collections.abc import Iterator

    from desire_tui.convert.xppaut.building import Building
    from desire_tui.convert.xppaut.declarations import Declaration

_FLAG = re.compile(r"([-+]?[01])\s*(?:\{([^{}]*)\}|([^{}]*))\s*\{([^{}]*)\}\s*\Z")
_STOP = "arret"
"""Assigned in a flag, it ends the run."""
_IDLE = frozenset({"out_put"})


def events(building: Building) -> Iterator[Event]:
    """Yield events for a file's flags: one for a sign, two where both directions count."""
    for one in building.declarations:
        if one.kind == "global":
            yield from _of(one, building)


def _of(one: Declaration, building: Building) -> Iterator[Event]:
    line = one.line
    found = _FLAG.match(one.right)
    if found is None:
        building.refuse(line, "it is no `global sign {condition} {name=formula;…}`")
        return
    if building.options.is_map:
        building.refuse(line, "flags in maps have no counterpart here")
        return
    sign = int(found[1])
    condition = building.formula((found[2] or found[3]).strip(), line)
    assignments: list[Quantity] = []
    ends_run = False
    for part in found[4].split(";"):
        name, equals, formula = part.partition("=")
        key = name.strip().lower()
        if not part.strip():
            continue
        if key == _STOP:
            ends_run = True
        elif key in _IDLE:
            building.note(line, part.strip(), "samples are taken at communication points only")
        elif not equals or key not in building.spelling:
            building.refuse(line, f"'{part.strip()}' assigns to nothing that is declared")
        else:
            target = building.spelling[key]
            assignments.append(Quantity(target, building.formula(formula, line)))
    if sign == 0 and condition == Name("t"):  # the usual way to compute initial values
        yield Event(None, assignments, line.comment, at_start=Relation("=", condition, number(0.0)))
        return
    for rising in _rising(condition, sign):
        yield Event(rising, assignments, line.comment, ends_run=ends_run)


def _rising(condition: Expression, sign: int) -> list[Expression]:
    falling = condition.operand if isinstance(condition, Negative) else Negative(condition)
    return {1: [condition], -1: [falling], 0: [condition, falling]}[sign]
