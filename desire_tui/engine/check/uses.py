"""What a script calls and runs: PROCEDUREs and segments that exist, with as many arguments as they take.

The script finds these at run time, one by one; here they are reported all at once, before a run.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.check.unknown import may_be_stopped
from desire_tui.engine.diagnostics import Diagnostic, closest
from desire_tui.engine.library import LIBRARY
from desire_tui.engine.nodes.commands import Drun
from desire_tui.engine.nodes.control import CallProcedure
from desire_tui.engine.nodes.declarations import Function
from desire_tui.engine.nodes.expressions import Call
from desire_tui.engine.nodes.walk import parts_read

if TYPE_CHECKING:
    from collections.abc import Iterator

    from desire_tui.engine.nodes.program import Placed, Program
    from desire_tui.engine.structure.structure import Structure


def unfit_uses(program: Program, structure: Structure) -> list[Diagnostic]:
    """Return errors 201, 215, and 44 and 56 for numbers of arguments, of the script."""
    in_bodies = {id(p) for s in structure.submodels.values() for p in s.body}
    stopped = may_be_stopped(program)  # commands may define FUNCTIONs anew
    problems: list[Diagnostic] = []
    for placed in program.script:
        if id(placed) in in_bodies:
            continue
        node = placed.node
        if isinstance(node, CallProcedure):
            problems.extend(_call(program, structure, placed, node))
        elif isinstance(node, Drun):
            problems.extend(_drun(program, placed, node))
        if not stopped:
            calls = (part for part in parts_read(node) if isinstance(part, Call))
            problems.extend(p for call in calls if (p := _function(program, structure, placed, call)))
    return problems


def _call(
    program: Program, structure: Structure, placed: Placed, node: CallProcedure
) -> Iterator[Diagnostic]:
    found = structure.procedures.get(node.name)
    if found is None:
        facts: dict[str, object] = {"name": node.name, "close": closest(node.name, structure.procedures)}
        yield Diagnostic("undefined-procedure", placed.span(), facts, program.source)
        return
    for given, needed, where in (
        (node.values, found.node.values, " before the ;"),
        (node.references, found.node.references, " behind the ;"),
    ):
        if len(given) != len(needed):
            facts = {"name": node.name, "given": len(given), "needed": len(needed), "where": where}
            yield Diagnostic("arguments-do-not-match", placed.span(), facts, program.source)


def _drun(program: Program, placed: Placed, node: Drun) -> Iterator[Diagnostic]:
    if program.segment(node.label) is not None:
        return
    if node.label is not None:
        facts = {"label": node.label, "name": node.label}
        yield Diagnostic("no-such-segment", placed.span(), facts, program.source)
    elif not program.problems:  # one of them may be DYNAMIC
        yield Diagnostic("no-dynamic-segment", placed.span(), {}, program.source)


def _function(program: Program, structure: Structure, placed: Placed, call: Call) -> Diagnostic | None:
    """Return what is wrong with the number of a call's arguments."""
    given = len(call.args)
    own, entry = structure.functions.get(call.name), LIBRARY.get(call.name)
    if own is not None:
        dummies = own.node.dummies if isinstance(own.node, Function) else ()
        if given == len(dummies):
            return None
        facts: dict[str, object] = {"name": call.name, "given": given, "needed": len(dummies), "where": ""}
        return Diagnostic("arguments-do-not-match", placed.span(call), facts, program.source)
    if entry is None or entry.fewest <= given <= entry.most:
        return None
    facts = {"name": call.name, "given": given, "needed": entry.parameters}
    return Diagnostic("argument-count", placed.span(call), facts, program.source)
