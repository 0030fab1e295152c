"""Weighted sums of stage derivatives, written the same way wherever they are computed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.integration.tableaus import whole_multiples

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.codegen.ir.lanes import Lanes
    from desire_tui.engine.integration.tableaus import Row


def scaled(lanes: Lanes, row: Row, dt: str) -> str:
    """Write dt divided by the row's denominator, once for all states."""
    denominator, _ = whole_multiples(row)
    return dt if denominator == 1 else lanes.div(dt, lanes.const(float(denominator)))


def weighted(lanes: Lanes, row: Row, k: Callable[[int], str]) -> str:
    """Write Σ numerator·k, in the order of the stages; `k(stage)` reads a derivative, stages from 1."""
    _, numerators = whole_multiples(row)
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
