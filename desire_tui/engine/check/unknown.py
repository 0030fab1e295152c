"""Names that a script uses and no statement assigns, declares or defines: most are misspelt.

Only what no statement of the whole program could supply is reported, so a correct program never is.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.cancellation import cancellation_point
from desire_tui.engine.diagnostics import Diagnostic, closest
from desire_tui.engine.library import LIBRARY
from desire_tui.engine.nodes.commands import Simple
from desire_tui.engine.nodes.declarations import Declare
from desire_tui.engine.nodes.display import Display
from desire_tui.engine.nodes.expressions import Call, Element, Name
from desire_tui.engine.nodes.statements import SegmentOnlyStatement
from desire_tui.engine.nodes.walk import parts_read
from desire_tui.engine.values import SYSTEM_VARIABLES

if TYPE_CHECKING:
    from collections.abc import Collection

    from desire_tui.engine.nodes.program import Placed, Program
    from desire_tui.engine.structure.structure import Structure

_SEGMENT_WORDS = frozenset({"OUT", "step", "JACOBIAN", "end event"})
_SCRIPT_CONSTANTS = frozenset({"j", "PI"})


def unknown_names(
    program: Program, structure: Structure, assigned: Collection[str], arrays: Collection[str]
) -> list[Diagnostic]:
    """Return errors 200 for names of the script that nothing assigns, 19 for elements of what is no array.

    `assigned`: every name that could be, `arrays`: those declared as arrays.
    """
    if may_be_stopped(program):
        return []  # commands may assign anything
    known = {*assigned, *SYSTEM_VARIABLES, *_SCRIPT_CONSTANTS}
    functions = {*LIBRARY, *structure.functions, "$In", "$Tr"}
    in_bodies = {id(p) for s in structure.submodels.values() for p in s.body}
    subscripted = {*arrays}
    for procedure in structure.procedures.values():
        subscripted.update(procedure.node.references, procedure.node.values)
    problems: list[Diagnostic] = []
    reported: set[str] = set()
    for placed in program.script:
        cancellation_point()
        if id(placed) in in_bodies or isinstance(placed.node, Declare | Display | SegmentOnlyStatement):
            continue
        for part in parts_read(placed.node):
            name = part.name
            if name in reported:
                continue
            is_call = isinstance(part, Call)
            if isinstance(part, Element) and name in known and name not in subscripted:
                reported.add(name)
                facts = {"name": name, "close": closest(name, arrays)}
                problems.append(Diagnostic("not-an-array", placed.span(part), facts, program.source))
                continue
            if name in (functions if is_call else known) or (is_call and name in known):
                continue
            reported.add(name)
            problems.append(_problem(program, placed, part, functions if is_call else known))
    return problems


def may_be_stopped(program: Program) -> bool:
    """Whether a script stops for commands."""
    return any(isinstance(p.node, Simple) and p.node.word in {"STOP", "go"} for p in program.script)


def misplaced(program: Program, structure: Structure) -> list[Diagnostic]:
    """Return errors 300: statements of DYNAMIC segments in the script (bodies of submodels may hold them)."""
    in_bodies = {id(p) for s in structure.submodels.values() for p in s.body}
    return [
        Diagnostic("not-in-script", placed.span(), {}, program.source)
        for placed in program.script
        if id(placed) not in in_bodies
        and (
            isinstance(placed.node, SegmentOnlyStatement)
            or (isinstance(placed.node, Simple) and placed.node.word in _SEGMENT_WORDS)
        )
    ]


def _problem(
    program: Program, placed: Placed, part: Name | Element | Call, known: Collection[str]
) -> Diagnostic:
    keys = {Call: "undefined-function", Element: "not-an-array"}
    key = keys.get(part.__class__, "undefined-variable")
    if isinstance(part, Name) and part.name in LIBRARY:
        return Diagnostic(
            "function-without-arguments", placed.span(part), {"name": part.name}, program.source
        )
    facts = {"name": part.name, "close": closest(part.name, known)}
    return Diagnostic(key, placed.span(part), facts, program.source)
