"""`data 'measured.csv'`: each column of a file of measurements becomes a table for `func1`, by its name."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.data_classes import replace
from desire_tui.engine.data_files.data_file import read_program_data
from desire_tui.engine.data_files.table_names import table_names
from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.nodes.names import segment_targets

if TYPE_CHECKING:
    from desire_tui.engine.data_files.data_file import DataFile
    from desire_tui.engine.interpreter.code_table import Operation
    from desire_tui.engine.interpreter.statement_context import StatementContext
    from desire_tui.engine.nodes.files import LoadData


def load_data(context: StatementContext, node: LoadData) -> Operation:
    """Make the operation of `data 'file'`: tables of 2n numbers, n times and then the n values there.

    Rows in which a column's value or the time is missing are left out of its table; rows are put into the
    order of their times. Errors 451: the program may not read the file; 18, 38, 531 … 534: what is wrong with
    it; 73: names that have another meaning.
    """

    def action() -> None:
        file = read_program_data(context.host.permit(Path(node.file.strip()), "read"))
        context.values.times_of_files[file.time] = file.name
        names = table_names(file.columns)
        problems = _names_taken(context, file, names)
        if problems:
            raise DesireError(*problems)
        notes = list(file.notes)
        notes += [
            f"{file.name}: the table of {column} is called {name}"
            for column, name in names.items()
            if name != column
        ]
        if not names:
            notes.append(
                f"{file.name}: its only column, {file.time}, is that of the times: there is no table"
            )
        before = context.values.replacements
        for column, name in names.items():
            table = np.concatenate(file.measured(column))
            if len(table):
                context.values.data[_slots(context, name, len(table))] = table
            else:
                notes.append(f"{file.name}: no table is made of {column}, which has no values")
        if context.values.replacements != before:
            context.machine.forget()  # code made so far knows what these names were
        for note in notes:
            warning = replace(_at(context, "data-note", {"what": note}), severity="warning")
            context.host.warn(DesireError(warning))

    return context.then(action)


def _slots(context: StatementContext, name: str, count: int) -> slice:
    slot = context.values.table(name, count).slot
    return slice(slot, slot + count)


def _names_taken(context: StatementContext, file: DataFile, names: dict[str, str]) -> list[Diagnostic]:
    """Return errors 73 for all tables whose names the program uses otherwise."""
    problems = []
    met: dict[str, str] = {}
    for column, name in names.items():
        what = f"the column {met[name]} of that file" if name in met else _meaning(context, name)
        met.setdefault(name, column)
        if what is not None:
            facts: dict[str, object] = {"name": name, "column": column, "file": file.name, "what": what}
            problems.append(_at(context, "data-name-taken", facts))
    return problems


def _meaning(context: StatementContext, name: str) -> str | None:
    """Return what a name means already, but for a table of a file."""
    scope, values = context.scope, context.values
    if name in scope.functions:
        return "a FUNCTION"
    if name in scope.procedures:
        return "a PROCEDURE"
    if name in scope.dummies:
        return "an argument of this PROCEDURE"
    if name in segment_targets(context.machine.program):
        return "a quantity of a DYNAMIC segment"
    known = values.find(name)
    if known is None or known.of_file:
        return None
    if known.shape:
        return f"the array {name}[{','.join(map(str, known.shape))}]"
    return "a state" if known.is_state else "a number" if values.is_defined(known) else None


def _at(context: StatementContext, key: str, facts: dict[str, object]) -> Diagnostic:
    return Diagnostic(key, context.placed.span(), facts, context.code.text.source)
