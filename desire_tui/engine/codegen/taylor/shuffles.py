"""Lanes of several vectors put together as new vectors."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from desire_tui.engine.codegen.ir.lanes import Lanes


class Lane(NamedTuple):
    """A vector's lane; None: `value` is a number."""

    value: str
    at: int | None


def collected(lanes: Lanes, given: list[Lane]) -> list[str]:
    """Return vectors of the lanes given, in their order; what is behind the last is like that."""
    found = []
    for first in range(0, len(given), lanes.width):
        row = given[first : first + lanes.width]
        found.append(_vector(lanes, row + [row[-1]] * (lanes.width - len(row))))
    return found


def _vector(lanes: Lanes, row: list[Lane]) -> str:
    text, kind, width = lanes.text, lanes.kind, lanes.width
    if all(lane.at is None and lane.value == row[0].value for lane in row):
        return lanes.splat(row[0].value)
    sources = list(dict.fromkeys(lane.value for lane in row if lane.at is not None))
    total = sources[0] if sources else "poison"
    placed = [lane.at if lane.value == total else None for lane in row]
    while sources[1:] or placed != list(range(width)):
        if not sources:
            break
        other = sources[1] if sources[1:] else None
        mask = []
        for i, lane in enumerate(row):
            here = placed[i]
            if here is None and lane.at is not None and lane.value == other:
                here = width + lane.at
            mask.append("poison" if here is None else str(here))
        listed = ", ".join(f"i32 {entry}" for entry in mask)
        right = other or "poison"
        total = text.op(f"shufflevector {kind} {total}, {kind} {right}, <{width} x i32> <{listed}>")
        del sources[1:2]
        placed = [i if entry != "poison" else None for i, entry in enumerate(mask)]
        if other is None:
            break
    for i, lane in enumerate(row):
        if lane.at is None:
            total = text.op(f"insertelement {kind} {total}, double {lane.value}, i64 {i}")
    return total
