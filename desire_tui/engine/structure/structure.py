"""The blocks, labels, definitions and data of a flat program, and every problem with them in one go.

A script is a flat list of statements; here each opener finds its closer, each `go to` its place.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.structure.blocks import BlockSurvey
from desire_tui.engine.structure.jumps import check_jumps, match_segments
from desire_tui.engine.structure.outline import ProcedureText, Structure, SubmodelText

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.nodes.program import Placed, Program
    from desire_tui.engine.source import Source

_BLOCK_WORDS = frozenset(
    "if else proceed for next while repeat until end PROCEDURE SUBMODEL".split()  # noqa: SIM905 - a list of words reads better than a wall of quotes
) | {"end if", "end while"}


def structure(program: Program) -> Structure:
    """Find the structure of a program. Never raises: the problems are in the result."""
    # Where an opener or closer could not be parsed, its partner is not the user's second mistake.
    broken = any(p.facts.get(fact) in _BLOCK_WORDS for p in program.problems for fact in ("word", "close"))
    survey = BlockSurvey(program.script, program.source, broken)
    survey.found.faults.update(program.faults)
    survey.script()
    survey.find_line_numbers(program.lines)
    known = {segment.label for segment in program.segments}
    check_jumps(survey, known)
    match_segments(survey, program.segments)
    return survey.finished()


def script_structure(script: Sequence[Placed], source: Source) -> Structure:
    """Return the structure of statements that stand alone, such as a command line."""
    survey = BlockSurvey(tuple(script), source, broken=False)
    survey.script()
    check_jumps(survey, None)
    return survey.finished()


__all__ = ["ProcedureText", "Structure", "SubmodelText", "script_structure", "structure"]
