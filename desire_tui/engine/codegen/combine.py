"""Weighted sums of stage derivatives, written the same way wherever they are computed."""

from __future__ import annotations

from math import lcm
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.codegen.lanes import Lanes
    from desire_tui.engine.integration.tableaus import Row


def parts(row: Row) -> tuple[int, list[int]]:
    """Return a row as its common denominator and whole numerators: (1/6, 2/6, …) is 6, [1, 2, …]."""
    denominator = lcm(*(r.denominator for r in row))
    return denominator, [int(r * denominator) for r in row]


def scaled(lanes: Lanes, row: Row, dt: str) -> str:
    """Write dt divided by the row's denominator, once for all states."""
    denominator, _ = parts(row)
    return dt if denominator == 1 else lanes.div(dt, lanes.const(float(denominator)))


def weighted(lanes: Lanes, row: Row, k: Callable[[int], str]) -> str:
    """Write Σ numerator·k, in the order of the stages; `k(stage)` reads a derivative, stages from 1."""
    return _sum(lanes, parts(row)[1], k)


def _sum(lanes: Lanes, numerators: list[int], k: Callable[[int], str]) -> str:
    total = ""
    for stage, n in enumerate(numerators, 1):
        if n == 0:
            continue
        term = k(stage)
        if n == -1:
            term = lanes.neg(term)
        elif n != 1:
            term = lanes.mul(lanes.const(float(n)), term)
        total = lanes.add(total, term) if total else term
    return total


def moved(lanes: Lanes, start: str, row: Row, factor: str, k: Callable[[int], str]) -> str:
    """Write start + factor·Σ numerator·k for the `factor` that `scaled` gave.

    The last stage's share is added by itself, at the end: what follows waits for that derivative alone, not
    for the whole sum. A small model's time is such waiting: 5 % of Lorenz' equations under rule 3.
    """
    _, numerators = parts(row)
    last = max(i for i, n in enumerate(numerators) if n)
    if any(numerators[:last]):
        head = _sum(lanes, numerators[:last], k)
        start = lanes.add(start, lanes.mul(factor, head))
    share = k(last + 1)
    if numerators[last] != 1:
        share = lanes.mul(lanes.const(float(numerators[last])), share)
    return lanes.add(start, lanes.mul(factor, share))
