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
    if all(lane == row[0] and lane.at is None for lane in row):
        return lanes.splat(row[0].value)
    sources = list(dict.fromkeys(lane.value for lane in row if lane.at is not None))
    total, *others = sources or ["poison"]
    taken = [lane.at if lane.value == total else None for lane in row]
    if not others and any(at not in {None, i} for i, at in enumerate(taken)):
        others = ["poison"]
    for other in others:
        for i, lane in enumerate(row):
            if lane.value == other and lane.at is not None:
                taken[i] = width + lane.at
        mask = ", ".join("i32 poison" if at is None else f"i32 {at}" for at in taken)
        total = text.op(f"shufflevector {kind} {total}, {kind} {other}, <{width} x i32> <{mask}>")
        taken = [None if at is None else i for i, at in enumerate(taken)]
    for i, lane in enumerate(row):
        if lane.at is None:
            total = text.op(f"insertelement {kind} {total}, double {lane.value}, i64 {i}")
    return total
