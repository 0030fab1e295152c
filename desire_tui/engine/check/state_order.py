"""The order of a program's states in its text: the order of its `d/dt` lines."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.check.declared import DeclaredNames
from desire_tui.engine.gc_pause import undisturbed_allocation
from desire_tui.engine.nodes.expressions import Name
from desire_tui.engine.nodes.names import invocation
from desire_tui.engine.nodes.segment import Derivative
from desire_tui.engine.structure.structure import structure as find_structure

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from desire_tui.engine.nodes.program import Placed, Program


@undisturbed_allocation
def state_order(program: Program) -> tuple[str, ...]:
    """Return the names of the scalar states of all segments in the order of their `d/dt` lines.

    Memory laid out in this order lets the compiled code load neighbouring states together (performance.md 3).
    """
    found = find_structure(program)
    names: dict[str, None] = {}

    def collect(statements: Iterable[Placed], rename: Mapping[str, str], depth: int) -> None:
        for statement, _, _ in statements:
            if isinstance(statement, Derivative):
                if isinstance(statement.target, Name):
                    names.setdefault(rename.get(statement.target.name, statement.target.name))
                continue
            invoked = invocation(statement)
            if invoked is None:
                continue
            name, args = invoked
            submodel = found.submodels.get(name)
            if submodel is None or depth > 20:
                continue
            inner = {
                dummy: rename.get(argument.name, argument.name)
                for dummy, argument in zip(submodel.dummies, args, strict=False)
                if isinstance(argument, Name)
            }
            collect(submodel.body, inner, depth + 1)

    for segment in program.segments:
        collect(segment.body, {}, 0)
    arrays = DeclaredNames(program, found).array_names
    return tuple(name for name in names if name not in arrays)
