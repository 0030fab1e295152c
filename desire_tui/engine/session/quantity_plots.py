"""A quantity on a page of its own: an array over its index, scalars and elements over the last run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.graph.quantity_pages import array_page, history_page
from desire_tui.engine.interpreter.host import Interrupted
from desire_tui.engine.session.comparison import Variation, run_again
from desire_tui.engine.session.overrides import name_and_subscripts

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.graph.model import Graph
    from desire_tui.engine.graph.pages import GraphPages
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.session.runs import Runs
    from desire_tui.engine.session.workspace import Workspace
    from desire_tui.engine.values import Values

PlotOutcome = Literal["shown", "unknown", "no run", "constant", "changed", "failed"]
"""What became of it: `unknown` has no value; `constant` is not changed by the run; after `changed` programs
or forgotten names the run cannot be made again; it `failed` when made again."""


def plot_quantity(
    workspace: Workspace, runs: Runs, graphs: GraphPages, wanted: str, show: Callable[[Graph], object]
) -> PlotOutcome:
    """Plot `x`, `A` or `A[2,3]` on a page, which `show` is given.

    What the last run did not record is recorded by that run made once more. Then everything is put
    back: quantities, random numbers, positions of histories.
    """
    values = workspace.values
    try:
        name, subscripts = name_and_subscripts(wanted)
    except ValueError:
        return "unknown"
    quantity = values.find(name)
    if quantity is None or not values.is_defined(quantity):
        return "unknown"
    if quantity.shape and not subscripts:
        show(array_page(graphs, name, np.array(values.view(quantity))))
        return "shown"
    slot = _slot(values, name, subscripts)
    if slot is None:
        return "unknown"
    return _history(workspace, runs, graphs, wanted.replace(" ", ""), slot, show)


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


def _history(
    workspace: Workspace,
    runs: Runs,
    graphs: GraphPages,
    name: str,
    slot: int,
    show: Callable[[Graph], object],
) -> PlotOutcome:
    record = runs.kept[-1] if runs.kept else None
    if record is None or not record.count:
        return "no run"
    if slot in record.slots:
        show(history_page(graphs, name, record, record.slots.index(slot)))
        return "shown"
    program, script = workspace.runnable()
    if runs.run_of != (program.source.text, workspace.values.generation):
        return "changed"
    segment = workspace.segments.lowered(program, script, record.segment, record.rule)
    if not _changes(segment, slot, workspace.values):
        return "constant"
    try:
        with runs.restored():
            again = run_again(workspace, runs, record, Variation(), recorded=(name, slot))
    except Interrupted:
        raise
    except DesireError:
        return "failed"
    show(history_page(graphs, name, again, again.slots.index(slot)))
    return "shown"


def _changes(segment: Segment, slot: int, values: Values) -> bool:
    """Whether a run of the segment can change a number; arrays' elements are not looked at closely."""
    return (
        slot in segment.scalars
        or any(states.slot <= slot < states.slot + states.count for states in segment.states)
        or any(q.shape and q.slot <= slot < q.slot + q.slots for q in values)
    )
