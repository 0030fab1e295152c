"""Which tables the `data 'file'` statements of a program make, as far as that can be told before it runs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import dataclass, field
from desire_tui.engine.diagnostics import Diagnostic
from desire_tui.engine.nodes.display import Request
from desire_tui.engine.nodes.expressions import Call, Element, Name
from desire_tui.engine.nodes.files import LoadData, Write
from desire_tui.engine.nodes.names import segment_targets
from desire_tui.engine.nodes.walk import parts_read

if TYPE_CHECKING:
    from collections.abc import Iterator

    from desire_tui.engine.nodes.program import Program
    from desire_tui.engine.nodes.statements import Statement

_TABLES = {"func1": 1, "func2": 2}
"""How many numbers stand in front of the tables among a function's arguments."""


@dataclass
class DataColumns:
    """What the files of a program's `data` statements hold.

    `names` are tables that are there; `perhaps` what may be one, since a file could not be looked at: names
    that stand where only arrays do. `taken`: errors 73.
    """

    names: set[str] = field(default_factory=set)
    perhaps: set[str] = field(default_factory=set)
    taken: list[Diagnostic] = field(default_factory=list)
    times: dict[str, str] = field(default_factory=dict)
    """The columns of times, which have no tables, and their files."""


def data_columns(program: Program) -> DataColumns:
    """Look at the first lines of the files that a program names."""
    found = DataColumns()
    statements = [placed for placed in program.script if isinstance(placed.node, LoadData)]
    if not statements:
        return found
    from desire_tui.engine.data_files.data_file import time_column  # few programs read files: 2 ms
    from desire_tui.engine.data_files.table_names import columns_beside, table_names

    elsewhere = segment_targets(program)
    for placed in statements:
        assert isinstance(placed.node, LoadData)
        columns = columns_beside(program.source, placed.node.file)
        if columns is None:
            found.perhaps |= _names_of_arrays(program)
            continue
        found.times[time_column(columns)] = placed.node.file
        for column, name in table_names(columns).items():
            if name not in elsewhere:
                found.names.add(name)
                continue
            facts = {
                "name": name, "column": column, "file": placed.node.file,
                "what": "a quantity of a DYNAMIC segment",
            }  # fmt: skip
            found.taken.append(Diagnostic("data-name-taken", placed.span(), facts, program.source))
    return found


def _names_of_arrays(program: Program) -> set[str]:
    statements = [*program.script, *(placed for segment in program.segments for placed in segment.body)]
    return {name for placed in statements for name in _arrays_in(placed.node)}


def _arrays_in(node: Statement) -> Iterator[str]:
    """Yield names with subscripts, those of tables, and those that are written alone."""
    for part in parts_read(node):
        if isinstance(part, Element):
            yield part.name
        elif isinstance(part, Call) and part.name in _TABLES:
            yield from (a.name for a in part.args[_TABLES[part.name] :] if isinstance(a, Name))
    if isinstance(node, Request):
        yield from (item.name for item in node.items if isinstance(item, Name))
    if isinstance(node, Write):
        yield from (item.value.name for item in node.items if isinstance(item.value, Name))
