"""Quantities that a study cannot give values, or to no purpose: found before the first run.

A defined variable is computed anew by every pass of the segment: whatever it is given, all runs are the same.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.api.settings import slot_of
from desire_tui.engine.diagnostics import Diagnostic
from desire_tui.engine.lowered.effects import memory, reads, writes
from desire_tui.engine.lowered.statements import DelayLine, Set, SetDot, SetMat, SetVec
from desire_tui.engine.lowered.walk import walk_actions, walk_values
from desire_tui.engine.nodes.declarations import Declare
from desire_tui.engine.nodes.expressions import Number
from desire_tui.engine.nodes.names import declared
from desire_tui.engine.session.dependent_assignments import dependents
from desire_tui.engine.session.overrides import WORD, name_and_subscripts

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from desire_tui.api.instance import Instance
    from desire_tui.engine.lowered.effects import Piece
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.nodes.program import Placed, Program
    from desire_tui.engine.structure.structure import Structure

    Computed = Set | SetDot | SetVec | SetMat


def computed_anyway(names: Iterable[str], instance: Instance) -> list[Diagnostic]:
    """Return errors 517: quantities whose given value neither the script nor the segment of a run reads."""
    script, prepared = instance.prepared.script, instance.prepared
    problems = []
    for name in names:
        own, _ = name_and_subscripts(name)
        slot = slot_of(name, instance)
        if slot is None or dependents(*script, prepared.place, {own}) != []:
            continue
        is_scalar = not instance.session.values.names[own].shape
        if is_scalar and slot not in prepared.segment.scalars:
            continue
        action = _computes_first(prepared.segment, slot)
        if action is not None:
            problems.append(_problem(name, own, action, instance))
    return problems


def known_shapes(names: Iterable[str], instance: Instance) -> dict[str, tuple[int, ...]]:
    """Return the shapes of those arrays among `names` that have the same in all runs, by their names."""
    script, place, values = instance.prepared.script, instance.prepared.place, instance.session.values
    every = {name_and_subscripts(name)[0] for name in names}
    found = {own: values.find(own) for own in every}
    return {
        own: quantity.shape
        for own, quantity in found.items()
        if quantity is not None and dependents(*script, place, every - {own}) is not None
    }


def elements_beyond(
    names: Iterable[str],
    program: Program,
    structure: Structure,
    shapes: Mapping[str, tuple[int, ...]] | None = None,
) -> list[Diagnostic]:
    """Return errors 2, 53: elements that no run has.

    Arrays have the `shapes`, or those that the script's one declaration gives as numbers.
    """
    problems = []
    for name in names:
        own, subscripts = name_and_subscripts(name)
        placed = _declaration(own, program, structure) if subscripts else None
        shape = (shapes or {}).get(own) or (_dimensions(own, placed) if placed else None)
        if placed is None or shape is None:
            continue
        if len(subscripts) != len(shape):
            facts: dict[str, object] = {"name": own, "given": len(subscripts), "needed": len(shape)}
            problems.append(Diagnostic("script-subscript-count", placed.span(), facts, program.source))
            continue
        for at, (subscript, size) in enumerate(zip(subscripts, shape, strict=True), 1):
            if not 1 <= subscript <= size:
                facts = {"value": subscript, "size": size, "place": at}
                key = "script-subscript-out-of-range"
                problems.append(Diagnostic(key, placed.span(), facts, program.source))
    return problems


def _declaration(name: str, program: Program, structure: Structure) -> Placed | None:
    """Return the one statement that declares an array, in no block."""
    found = [
        (placed, structure.inside[number] < 0)
        for number, placed in enumerate(program.script)
        if isinstance(placed.node, Declare) and name in declared(placed.node)
    ]
    return found[0][0] if len(found) == 1 and found[0][1] else None


def _dimensions(name: str, placed: Placed) -> tuple[int, ...] | None:
    """Return the dimensions that a declaration gives a name, if they are numbers."""
    assert isinstance(placed.node, Declare)
    parts = [part for group in placed.node.groups for part in group.parts if part.name == name]
    sizes = parts[0].dimensions if parts else ()  # the whole of an overlay is no part of it
    numbers = [int(size.value) for size in sizes if isinstance(size, Number)]
    return tuple(numbers) if sizes and len(numbers) == len(sizes) else None


def _computes_first(segment: Segment, slot: int) -> Computed | None:
    """Return the statement that assigns a slot in every pass, if nothing reads the slot before."""
    if _meets(_read_elsewhere(segment), slot):
        return None
    for action in segment.body:
        if any(_meets(reads(each), slot) for each in walk_actions((action,))):
            return None
        if _meets(writes(action), slot):  # what stands under a condition is no write of its guard
            return action if isinstance(action, Set | SetDot | SetVec | SetMat) else None
    return None


def _read_elsewhere(segment: Segment) -> list[Piece]:
    """Return what is read before the first pass or aside from its order: how far delays reach."""
    values = [value for delay in segment.delays for value in (delay.source, delay.tau)]
    values += [action.tau for action in walk_actions(segment.body) if isinstance(action, DelayLine)]
    return [piece for node in walk_values(*values) for piece in memory(node)]


def _meets(pieces: Iterable[Piece], slot: int) -> bool:
    return any(first <= slot < first + length for first, length in pieces)


def _problem(name: str, own: str, action: Computed, instance: Instance) -> Diagnostic:
    source, span = instance.prepared.segment.source, action.where.span
    words = dict.fromkeys(WORD.findall(source.text[span.start : span.end]))
    read = [word for word in words if word != own and word in instance.session.values.names]
    remedy = (
        f"vary what it is computed from: {', '.join(read)}"
        if read
        else "take its line out of the DYNAMIC segment, and give it a value in the script"
    )
    return Diagnostic("study-computed", span, {"name": name, "remedy": remedy}, source)
