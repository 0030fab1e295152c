"""From a parsed program to a lowered segment, with the values that hold at its `drun`."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import replace
from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.diagnostics.spelling import few_hints
from desire_tui.engine.gc_pause import undisturbed_allocation
from desire_tui.engine.lowering.lowering_context import FunctionText
from desire_tui.engine.lowering.scope import LiveScope
from desire_tui.engine.lowering.segments import lower_segment
from desire_tui.engine.nodes.declarations import Function
from desire_tui.engine.structure.structure import structure as find_structure

if TYPE_CHECKING:
    from collections.abc import Iterable

    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.nodes.program import Program
    from desire_tui.engine.structure.structure import Structure
    from desire_tui.engine.values import Values


@undisturbed_allocation
@few_hints()
def lower(
    program: Program,
    label: str | None,
    values: Values,
    structure: Structure | None = None,
    rule: int | None = None,
) -> Segment:
    """Return a segment ready for a back end, names and shapes as they are now.

    `label` None means the unlabelled one. DesireError: every problem of the segment at once; 215 or 68 if
    there is no such segment.
    """
    text = program.segment(label)
    if text is None:
        key = "no-dynamic-segment" if label is None else "no-such-segment"
        raise DesireError(Diagnostic(key, facts={"label": label}, source=program.source))
    found = structure if structure is not None else find_structure(program)
    scope = LiveScope(values)
    segment, problems = lower_segment(text, scope, program.source, functions_of(found), found, rule)
    if problems:
        causes = without_consequences(problems, program, found.problems)
        raise DesireError(
            *in_order(causes or problems)
        )  # a cause that the script has not met yet is no reason
    return replace(segment, constants=tuple(scope.constants.items())) if scope.constants else segment


def functions_of(structure: Structure) -> dict[str, FunctionText]:
    """Return the program's FUNCTIONs by name."""
    return {
        name: FunctionText(placed.node, placed.at)
        for name, placed in structure.functions.items()
        if isinstance(placed.node, Function)
    }


def without_consequences(
    problems: Iterable[Diagnostic], program: Program, others: Iterable[Diagnostic]
) -> list[Diagnostic]:
    """Leave out that names are unknown which may get their meaning on lines that are wrong themselves.

    Those are what could not be read, and definitions among `others`.
    """
    causes = [*program.problems, *(p for p in others if p.key in _UNUSABLE)]
    if not causes:
        return list(problems)
    names = set[str]()
    for cause in causes:
        if cause.span is not None:
            line = program.source.line(program.source.position(cause.span.start).row)
            names.update(_WORD.findall(line))
    return [p for p in problems if p.code not in _MISSING or p.facts.get("name") not in names]


_WORD = re.compile(r"[A-Za-z][\w$]*")
_MISSING = frozenset({19, 59, 70, 200, 201, 215})
"""A name is unknown."""
_UNUSABLE = frozenset({"dummy-twice", "nested-definition", "unclosed-definition", "system-variable-declared"})
"""What a definition is wrong by that nobody can use."""


def in_order(problems: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Sort by place; of several that say the same about one place, the first stays."""
    unique: dict[tuple[int, object], Diagnostic] = {}
    for problem in problems:
        unique.setdefault((problem.code, problem.span or id(problem)), problem)
    return sorted(unique.values(), key=lambda d: d.span or (0, 0))
