"""Weighted sums of stage derivatives, written the same way wherever they are computed."""

from __future__ import annotations

from math import lcm
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.codegen.ir.lanes import Lanes
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
    _, numerators = parts(row)
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
