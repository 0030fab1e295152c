"""Quantities on a page of their own: an array over its index, scalars, elements and columns over time."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Literal

import numpy as np

from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.graph.quantity_pages import array_page, history_page
from desire_tui.engine.interpreter.host import Interrupted
from desire_tui.engine.runtime.measured_points import points_of_table
from desire_tui.engine.session.comparison import Variation, run_again
from desire_tui.engine.session.overrides import name_and_subscripts

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.graph.model import Graph
    from desire_tui.engine.graph.pages import GraphPages
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.runtime.point_set import PointSet
    from desire_tui.engine.runtime.run_record import RunRecord
    from desire_tui.engine.session.runs import Runs
    from desire_tui.engine.session.workspace import Workspace
    from desire_tui.engine.values import Values

_COMMA = re.compile(r",(?![^\[]*\])")
"""Between names, not between subscripts."""
PlotOutcome = Literal["shown", "unknown", "array", "no run", "constant", "changed", "failed"]
"""What became of it: `unknown` has no value; an `array` is plotted alone; `constant` is not changed by the
run; after `changed` programs or forgotten names the run cannot be made again; it `failed` when made again."""


def plot_quantities(
    workspace: Workspace, runs: Runs, graphs: GraphPages, wanted: str, show: Callable[[Graph], object]
) -> tuple[PlotOutcome, str]:
    """Plot `x`, `A`, `A[2,3]`, or several such as `x, position`, on a page, which `show` is given.

    Columns of data files are points. What the last run did not record is recorded by that run made once more.
    Then everything is put back: quantities, random numbers, positions of histories. Returns what became of
    it, and of which name.
    """
    values = workspace.values
    numbers: list[tuple[str, int]] = []
    points: list[PointSet] = []
    names = [name.strip() for name in _COMMA.split(wanted)]
    for given in names:
        try:
            name, subscripts = name_and_subscripts(given)
        except ValueError:
            return "unknown", given
        quantity = values.find(name)
        if quantity is None or not values.is_defined(quantity):
            return "unknown", given
        if quantity.shape and not subscripts:
            if quantity.of_file:
                table = values.data[quantity.slot : quantity.slot + quantity.size]
                points.append(points_of_table(name, table))
                continue
            if len(names) > 1:
                return "array", given
            show(array_page(graphs, name, np.array(values.view(quantity))))
            return "shown", given
        slot = _slot(values, name, subscripts)
        if slot is None:
            return "unknown", given
        numbers.append((given.replace(" ", ""), slot))
    record: RunRecord | None = None
    if numbers:
        record = runs.kept[-1] if runs.kept else None
        if record is None or not record.count:
            return "no run", numbers[0][0]
        missing = [(name, slot) for name, slot in numbers if slot not in record.slots]
        if missing:
            record, became = _recorded(workspace, runs, record, missing)
            if record is None:
                return became
    show(history_page(graphs, record, numbers, points))
    return "shown", wanted


def _slot(values: Values, name: str, subscripts: tuple[int, ...]) -> int | None:
    """Return where a scalar or an element (subscripts from 1) stands; None: there is no such number."""
    quantity = values.names[name]
    if len(subscripts) != len(quantity.shape):
        return None
    if not all(1 <= k <= n for k, n in zip(subscripts, quantity.shape, strict=True)):
        return None
    at = 0
    for k, n in zip(subscripts, quantity.shape, strict=True):
        at = at * n + k - 1
    return quantity.slot + at * (quantity.slots // quantity.size)


def _recorded(
    workspace: Workspace, runs: Runs, record: RunRecord, missing: list[tuple[str, int]]
) -> tuple[RunRecord | None, tuple[PlotOutcome, str]]:
    """Return the run made once more with more quantities (names, slots); None: why that cannot be."""
    program, script = workspace.runnable()
    if runs.run_of != (program.source.text, workspace.values.generation):
        return None, ("changed", missing[0][0])
    segment = workspace.segments.lowered(program, script, record.segment, record.rule)
    for name, slot in missing:
        if not _changes(segment, slot, workspace.values):
            return None, ("constant", name)
    try:
        with runs.restored():
            again = run_again(workspace, runs, record, Variation(), recorded=missing)
    except Interrupted:
        raise
    except DesireError:
        return None, ("failed", missing[0][0])
    return again, ("shown", missing[0][0])


def _changes(segment: Segment, slot: int, values: Values) -> bool:
    """Whether a run of the segment can change a number; arrays' elements are not looked at closely."""
    return (
        slot in segment.scalars
        or any(states.slot <= slot < states.slot + states.count for states in segment.states)
        or any(q.shape and q.slot <= slot < q.slot + q.slots for q in values)
    )
