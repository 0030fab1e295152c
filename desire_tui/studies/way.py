"""Which way the runs of a study are made: one prepared run again and again, or the whole script each time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.nodes.commands import Drun
from desire_tui.engine.nodes.control import CallProcedure, GoTo
from desire_tui.engine.nodes.names import assigned
from desire_tui.engine.random_sequence import DRAWS
from desire_tui.engine.session.overrides import WORD

if TYPE_CHECKING:
    from desire_tui.engine.nodes.program import Program
    from desire_tui.engine.structure.structure import Structure
    from desire_tui.studies.keep import KeptList


def is_one_run(program: Program, structure: Structure, kept: KeptList) -> bool:
    """Whether all that a study keeps is known at the end of the script's one run, made once and for certain.

    Where the script itself draws random numbers, each run needs numbers of its own there too.
    """
    script = program.script
    places = [place for place, placed in enumerate(script) if isinstance(placed.node, Drun)]
    if any(isinstance(placed.node, GoTo) for placed in script) or len(places) > 1:
        return False
    place = places[0] if places else len(script)
    if places and structure.inside[place] >= 0:
        return False
    text = program.source.text
    for placed in script:
        span = placed.span()
        if not DRAWS.keys().isdisjoint(WORD.findall(text[span.start : span.end])):
            return False
    wanted = set[str]()
    for item in kept.items:
        wanted.update(WORD.findall(item.expression.text))
    behind = script[place + 1 :]
    if any(isinstance(placed.node, CallProcedure) for placed in behind):
        return False
    changed = (assigned(placed.node) for placed in behind)
    return all(
        wanted.isdisjoint((*(target.name for target in each.targets), *each.arrays)) for each in changed
    )


def of_the_script(program: Program, kept: KeptList) -> dict[int, str]:
    """Return the items, by number, that are final values of what the script alone computes."""
    computed = set[str]()
    for segment in program.segments:
        for placed in segment.body:
            found = assigned(placed.node)
            computed.update(target.name for target in found.targets)
            computed.update(found.arrays)
    from desire_tui.engine.session.overrides import name_and_subscripts

    given = {
        name
        for placed in program.script
        for found in (assigned(placed.node),)
        for name in (*(target.name for target in found.targets), *found.arrays)
    }
    results: dict[int, str] = {}
    for number, item in enumerate(kept.items):
        if item.kind != "last":
            continue
        try:
            name, _ = name_and_subscripts(item.expression.text)
        except ValueError:
            continue
        if name in given and name not in computed:
            results[number] = item.expression.text
    return results
