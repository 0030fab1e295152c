"""`input #n` from a file that names its columns: a row into scalars, whole columns into arrays."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.interpreter.exception_mapping import ScriptFault
from desire_tui.engine.nodes.expressions import Name
from desire_tui.engine.values import Quantity

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from desire_tui.engine.data_files.data_table import DataTable
    from desire_tui.engine.interpreter.statement_context import StatementContext
    from desire_tui.engine.nodes.expressions import Target
    from desire_tui.engine.nodes.files import Input

    Filler = Callable[[Callable[[], complex]], None]


def table_input(
    context: StatementContext, node: Input, channel: int, table: DataTable, fillers: Sequence[Filler]
) -> None:
    """Fill the targets from their columns; error 18: there is no such column, row or number.

    Columns are found by the targets' names. Where no name agrees, as many targets as there are columns take
    them in their order, and a matrix with as many columns takes whole rows.
    """
    channels, check = context.machine.channels, context.machine.check
    sizes = [_size(context, target) for target in node.targets]
    places = _columns_of(context, node, channel, table)
    if places is None:
        width = len(table.names)
        columns = channels.columns(channel, range(width), sizes[0] // width, check)
        rows = (value for row in zip(*columns, strict=True) for value in row)
        fillers[0](rows.__next__)
        return
    for target, size in zip(node.targets, sizes, strict=True):
        if size != sizes[0]:
            first = node.targets[0].name
            raise ScriptFault(
                "columns-unequal", target, name=target.name, size=size, first=first, have=sizes[0]
            )
    columns = channels.columns(channel, places, sizes[0], check)
    for fill, column in zip(fillers, columns, strict=True):
        fill(iter(column).__next__)


def _columns_of(context: StatementContext, node: Input, channel: int, table: DataTable) -> list[int] | None:
    """Return the place of each target's column; None: the target is a matrix that takes whole rows."""
    found = [table.find(target.name) for target in node.targets]
    places = [place for place in found if place is not None]
    if len(places) == len(found):
        return places
    if not places:
        if len(found) == len(table.names):
            return list(range(len(found)))
        if len(found) == 1 and _width(context, node.targets[0]) == len(table.names):
            return None
    missing = node.targets[found.index(None)]
    file = context.machine.channels.name_of(channel)
    raise ScriptFault("column-missing", missing, file=file, **table.others(missing.name))


def _array(context: StatementContext, target: Target) -> Quantity | None:
    meaning = context.scope.assigned(target) if isinstance(target, Name) else None
    return meaning if isinstance(meaning, Quantity) and meaning.shape else None


def _size(context: StatementContext, target: Target) -> int:
    array = _array(context, target)
    return 1 if array is None else array.size


def _width(context: StatementContext, target: Target) -> int | None:
    array = _array(context, target)
    return array.shape[-1] if array is not None and len(array.shape) > 1 else None
