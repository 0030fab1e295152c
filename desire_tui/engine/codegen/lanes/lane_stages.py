"""States at a stage of a rule with fixed steps, for some runs side by side."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir.lanes import Lanes
from desire_tui.engine.codegen.lanes.lane_cells import Number
from desire_tui.engine.codegen.loop.stage_sums import scaled, weighted

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.codegen.lanes.lane_cells import LaneCells
    from desire_tui.engine.integration.tableaus import Row


def save(cells: LaneCells, states: Sequence[int]) -> None:
    """Keep the states at a step's start."""
    for number, slot in enumerate(states):
        cells.keep("x0", number, cells.load(slot))


def advance(cells: LaneCells, states: Sequence[int], row: Row, dt: str, *, from_zero: bool = False) -> None:
    """States ← saved states + dt·Σ row·k; `from_zero`: of -0 alone the sum is 0, as in `runtime.moments`."""
    runs, one = cells.runs, Lanes(cells.text)
    factor = scaled(one, row, dt)
    for number, slot in enumerate(states):
        wide = slot in cells.differing
        lanes = runs if wide else one
        total = weighted(lanes, row, lambda stage, n=number: cells.kept(f"k{stage}", n).name)  # type: ignore[misc]  # n=: bound now
        if from_zero:
            total = lanes.add(lanes.const(0.0), total)
        by = runs.splat(factor) if wide else factor
        moved = lanes.add(cells.kept("x0", number).name, lanes.mul(by, total))
        cells.store(slot, Number(moved, wide))
