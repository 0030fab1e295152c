"""The order of a program's states in its text: the order of its `d/dt` lines."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.cancellation import cancellation_point
from desire_tui.engine.check.declared import DeclaredNames
from desire_tui.engine.gc_pause import undisturbed_allocation
from desire_tui.engine.lowering.lowering_context import DEPTH_MAX
from desire_tui.engine.nodes.expressions import Name
from desire_tui.engine.nodes.lazy_parts import written_target
from desire_tui.engine.nodes.names import invocation
from desire_tui.engine.nodes.segment import Derivative
from desire_tui.engine.structure.expanded_lines import LINES_MOST, expanded_lines
from desire_tui.engine.structure.structure import structure as find_structure

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from desire_tui.engine.nodes.program import Placed, Program


_STATEMENTS_AT_ONCE = 100
"""Between two points where the work can be broken off."""


@undisturbed_allocation
def state_order(program: Program) -> tuple[str, ...]:
    """Return the names of the scalar states of all segments in the order of their `d/dt` lines.

    Memory laid out in this order lets the compiled code load neighbouring states together (performance.md 3).
    """
    found = find_structure(program)
    lines = expanded_lines(found.submodels)
    names: dict[str, None] = {}

    recursive: set[str] = set()

    def collect(statements: Iterable[Placed], rename: Mapping[str, str], calls: tuple[str, ...]) -> None:
        for number, (statement, _, _) in enumerate(statements):
            if number % _STATEMENTS_AT_ONCE == 0:
                cancellation_point()
            if isinstance(statement, Derivative):
                known = written_target(statement)
                if known is not None:
                    names.setdefault(rename.get(known, known))
                elif isinstance(statement.target, Name):
                    names.setdefault(rename.get(statement.target.name, statement.target.name))
                continue
            invoked = invocation(statement)
            if invoked is None:
                continue
            name, args = invoked
            submodel = found.submodels.get(name)
            if name in calls or len(calls) > DEPTH_MAX:
                recursive.add(name)
            if submodel is None or name in recursive or lines[name] > LINES_MOST:
                continue  # the last three are errors
            inner = {
                dummy: rename.get(argument.name, argument.name)
                for dummy, argument in zip(submodel.dummies, args, strict=False)
                if isinstance(argument, Name)
            }
            collect(submodel.body, inner, (*calls, name))

    for segment in program.segments:
        collect(segment.body, {}, ())
    arrays = DeclaredNames(program, found).array_names
    return tuple(name for name in names if name not in arrays)
