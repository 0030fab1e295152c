"""Which assignments of a script have to be made again when some of its values are given from outside.

`b = 2*a` behind `a = 1`, when `a` is set. Only where that alone gives the same numbers as the whole script
would with the value in place of its own.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.nodes.assignments import Assign
from desire_tui.engine.nodes.control import For, GoTo, Procedure
from desire_tui.engine.nodes.declarations import Declare
from desire_tui.engine.nodes.expressions import Name
from desire_tui.engine.nodes.names import declared
from desire_tui.engine.random_sequence import DRAWS
from desire_tui.engine.session.overrides import WORD

if TYPE_CHECKING:
    from desire_tui.engine.nodes.program import Placed, Program
    from desire_tui.engine.structure.structure import Structure


class _Line(NamedTuple):
    """A statement by the words in it."""

    placed: Placed
    target: str | None
    """What it assigns, if it is an assignment that is made exactly once."""
    reads: set[str]
    """Words of its expressions; of other statements all words."""
    is_element: bool = False
    """The target is an element of an array."""


def dependents(program: Program, structure: Structure, place: int, names: set[str]) -> list[Placed] | None:
    """Return the assignments that depend on `names` and lead to the statement at a place, in their order.

    None: something else depends on them, or assignments made again would not give the same numbers.
    """
    around = _around(structure, place)
    jumps = any(isinstance(placed.node, GoTo) for placed in program.script)
    is_straight = not jumps and not any(isinstance(program.script[k].node, Procedure) for k in around)
    above = program.script[:place] if is_straight else program.script
    lines = [_line(program, structure, number, placed, around) for number, placed in enumerate(above)]
    affected, found = set(names), dict[int, _Line]()
    for number, line in enumerate(lines):
        if (line.target in names and not line.is_element) or not line.reads & affected:
            continue
        node = line.placed.node
        if line.target is None or not is_straight or isinstance(node, For) or line.reads & DRAWS.keys():
            return None
        found[number] = line
        affected.add(line.target)
    if any(_is_overtaken(number, lines, found) for number in found):
        return None
    return [line.placed for line in found.values()]


def _around(structure: Structure, place: int) -> set[int]:
    """Return the places of the blocks around a statement."""
    around, block = set[int](), structure.inside[place] if place < len(structure.inside) else -1
    while block >= 0:
        around.add(block)
        block = structure.inside[block]
    return around


def _line(program: Program, structure: Structure, number: int, placed: Placed, around: set[int]) -> _Line:
    node = placed.node
    block = structure.inside[number]
    once = block < 0 or block in around
    span = placed.span()
    words = set(WORD.findall(program.source.text[span.start : span.end]))
    if once and isinstance(node, Assign):
        value = placed.span(node.value)
        reads = set(WORD.findall(program.source.text[value.start : value.end]))
        if isinstance(node.target, Name):
            return _Line(placed, node.target.name, reads)
        return _Line(placed, node.target.name, words, is_element=True)
    if number in around and isinstance(node, For) and isinstance(node.variable, Name):
        return _Line(placed, node.variable.name, words - {node.variable.name, "for", "to", "step"})
    if isinstance(node, Declare) and all(group.whole is None for group in node.groups):
        return _Line(placed, None, words - {*declared(node)})  # elements that are set change no sizes
    return _Line(placed, None, words)


def _is_overtaken(number: int, lines: list[_Line], found: dict[int, _Line]) -> bool:
    """Whether what an assignment reads, or its own value, is changed further on by something else."""
    line = found[number]
    for later, other in enumerate(lines[number + 1 :], number + 1):
        written = {other.target} if other.target is not None else other.reads
        if written & line.reads or (later not in found and line.target in written):
            return True
    return False
