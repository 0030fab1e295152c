"""Programs of one run: those that may begin at their `drun` again, since all else they do stays the same."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.library import LIBRARY
from desire_tui.engine.nodes.assignments import Assign, Bare, Dot, MatrixAssign, VectorAssign
from desire_tui.engine.nodes.commands import Drun, Irule, Seed, Simple
from desire_tui.engine.nodes.control import CallProcedure, For, If, Label, Procedure, Until, While
from desire_tui.engine.nodes.declarations import Declare, Function, Submodel
from desire_tui.engine.nodes.display import Display, GraphText
from desire_tui.engine.nodes.files import Data, Read, Restore, Write
from desire_tui.engine.session.overrides import WORD

if TYPE_CHECKING:
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.nodes.program import Placed, Program
    from desire_tui.engine.source import Source
    from desire_tui.engine.structure.structure import Structure

_BEFORE = (
    Assign, Bare, Dot, MatrixAssign, VectorAssign, If, For, While, Until, Label, Procedure, CallProcedure,
    Declare, Function, Submodel, Data, Read, Restore, Write, Irule, Seed, Display, GraphText,
)  # fmt: skip
"""What a script may do in front of its run: it reads no files, asks nothing and draws no points."""
_WORDS = frozenset(("else", "proceed", "end if", "next", "end while", "repeat", "exit", "end", "DYNAMIC"))
_CLOCKS = {name for name, function in LIBRARY.items() if function.kind == "time"}
_BEHIND = (Assign, Write, Label)


def rest_of_script(program: Program, structure: Structure, place: int) -> list[Placed] | None:
    """Return what a script does behind its only run, which stands at `place`; None: it cannot be repeated."""
    script = program.script
    if not _CLOCKS.isdisjoint(WORD.findall(program.source.text)):
        return None
    if program.problems or structure.problems or place >= len(script) or structure.inside[place] >= 0:
        return None
    run = script[place].node
    if not isinstance(run, Drun) or run.reset or run.star:
        return None
    before, behind = script[:place], script[place + 1 :]
    if not all(_may_stand_before(placed) for placed in before):
        return None
    if not all(isinstance(placed.node, _BEHIND) and _to_console(placed) for placed in behind):
        return None
    return [placed for placed in behind if not isinstance(placed.node, Label)]


def may_be_repeated(source: Source) -> bool:
    """Whether a program looks as if it could be repeated: one `drun`, and nothing else that matters."""
    from desire_tui.engine.structure.structure import structure
    from desire_tui.engine.syntax.parse import parse

    program = parse(source)
    places = [place for place, placed in enumerate(program.script) if isinstance(placed.node, Drun)]
    return len(places) == 1 and rest_of_script(program, structure(program), places[0]) is not None


def is_repeatable(segment: Segment) -> bool:
    """Whether a segment leaves nothing but samples and values: no listing, no files, no pictures."""
    kinds = {request.kind for request in segment.requests}
    return not (kinds - {"dispt", "dispxy", "DISPXY"} or segment.stash or segment.recover or segment.pictures)


def _may_stand_before(placed: Placed) -> bool:
    node = placed.node
    if isinstance(node, Simple):
        return node.word in _WORDS
    return isinstance(node, _BEFORE) and _to_console(placed)


def _to_console(placed: Placed) -> bool:
    return not isinstance(placed.node, Write) or placed.node.channel is None
