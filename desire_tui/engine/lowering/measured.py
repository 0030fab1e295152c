"""Columns of data files among what a segment displays: points that are drawn over the run's curves."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.lowered.segment import MeasuredColumn, MeasuredPoints
from desire_tui.engine.lowering.scope import size_of
from desire_tui.engine.nodes.expressions import Name

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.lowering.lowering_context import LoweringContext
    from desire_tui.engine.nodes.display import Request
    from desire_tui.engine.nodes.expressions import Target


def split_measured(context: LoweringContext, node: Request) -> tuple[list[Target], dict[int, Name]]:
    """Return what a request samples, and columns of data files by their place among its names.

    Columns in a request that draws nothing are left out, which is error 536.
    """
    sampled: list[Target] = []
    measured: dict[int, Name] = {}
    for place, item in enumerate(node.items):
        if not isinstance(item, Name) or not _is_measured(context, item):
            sampled.append(item)
        elif node.kind in {"type", "stash", "recover"}:
            context.report("measured-not-sampled", item, name=context.actual(item.name), kind=node.kind)
        else:
            measured[place] = item
    return sampled, measured


def measured_curves(
    context: LoweringContext, node: Request, measured: dict[int, Name]
) -> tuple[MeasuredPoints, ...]:
    """Return the points of a display: of `dispt` over t, else of one column over another.

    Error 536: a column and a quantity of the run over each other, which have values at other times.
    """
    if node.kind == "dispt":
        return tuple(MeasuredPoints(_column(context, item)) for item in measured.values())
    if not measured:
        return ()
    found = []
    for y, x in _pairs(node.kind, len(node.items)):
        if y in measured and x in measured:
            found.append(MeasuredPoints(_column(context, measured[y]), _column(context, measured[x])))
        elif y in measured or x in measured:
            column, other = (y, x) if y in measured else (x, y)
            context.report(
                "measured-over-quantity", measured[column], name=context.actual(measured[column].name),
                other=_written(context, node.items, other),
            )  # fmt: skip
    return tuple(found)


def _pairs(kind: str, count: int) -> list[tuple[int, int]]:
    """Return the places of ordinates and their abscissas in `dispxy` and `DISPXY`."""
    if kind == "dispxy":
        return [(place, 0) for place in range(1, count)]
    return [(place + 1, place) for place in range(0, count - 1, 2)]


def _written(context: LoweringContext, items: Sequence[Target], place: int) -> str:
    return context.actual(items[place].name)


def _is_measured(context: LoweringContext, item: Name) -> bool:
    quantity = context.scope.names.get(context.actual(item.name))
    return quantity is not None and quantity.of_file


def _column(context: LoweringContext, item: Name) -> MeasuredColumn:
    quantity = context.scope.names[context.actual(item.name)]
    return MeasuredColumn(quantity.name, quantity.slot, size_of(quantity), context.where(item))
