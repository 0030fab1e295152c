"""From a parsed program to lowered segments: at `drun` with actual values, or only looking."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from desire_tui.engine.allocation import undisturbed_allocation
from desire_tui.engine.analysis.context import FunctionText
from desire_tui.engine.analysis.declared import Survey
from desire_tui.engine.analysis.scope import LiveScope
from desire_tui.engine.analysis.segments import lower_segment
from desire_tui.engine.analysis.structure import structure as find_structure
from desire_tui.engine.analysis.unknown import misplaced, unknown_names
from desire_tui.engine.analysis.uses import unfit_uses
from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.nodes import Bare, Call, Derivative, Function, Invoke, Name

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from desire_tui.engine.analysis.structure import Structure
    from desire_tui.engine.lowered import Segment
    from desire_tui.engine.nodes import Placed, Program
    from desire_tui.engine.values import Values

_WORD = re.compile(r"[A-Za-z][\w$]*")


@undisturbed_allocation
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
    segment, problems = lower_segment(text, scope, program.source, functions_of(found), found.submodels, rule)
    if problems:
        raise DesireError(*in_order(problems))
    return segment


@undisturbed_allocation
def check(program: Program) -> tuple[Diagnostic, ...]:
    """Return all problems that can be told before a run, in the order of the text.

    They come from syntax, structure and segments. A name counts as defined if any script statement before the
    segment's first `drun` could assign it; sizes that the script computes are not checked.
    """
    found = find_structure(program)
    problems = [*program.problems, *found.problems, *misplaced(program, found)]
    survey = Survey(program, found)
    functions = functions_of(found)
    for text in program.segments:
        scope = survey.scope_for(text)
        problems.extend(lower_segment(text, scope, program.source, functions, found.submodels)[1])
    problems.extend(unknown_names(program, found, survey.everything, survey.array_names))
    problems.extend(unfit_uses(program, found))
    broken = _names_in_broken_lines(program)
    return tuple(in_order(p for p in problems if p.code not in _MISSING or p.facts.get("name") not in broken))


_MISSING = frozenset({19, 59, 70, 200, 201, 215})
"""A name is unknown."""


def _names_in_broken_lines(program: Program) -> set[str]:
    """Return the names on lines that could not be parsed; they may be declared there: no second mistake."""
    source, names = program.source, set[str]()
    for problem in program.problems:
        if problem.span is not None:
            names.update(_WORD.findall(source.line(source.position(problem.span.start).row)))
    return names


@undisturbed_allocation
def state_order(program: Program) -> tuple[str, ...]:
    """Return the names of the scalar states of all segments in the order of their `d/dt` lines.

    Memory laid out in this order lets the compiled code load neighbouring states together (performance.md).
    """
    found = find_structure(program)
    names: dict[str, None] = {}

    def collect(statements: Iterable[Placed], rename: Mapping[str, str], depth: int) -> None:
        for statement, _, _ in statements:
            if isinstance(statement, Derivative):
                if isinstance(statement.target, Name):
                    names.setdefault(rename.get(statement.target.name, statement.target.name))
                continue
            if isinstance(statement, Invoke):
                name, args = statement.name, statement.args
            elif isinstance(statement, Bare) and isinstance(statement.value, Call):
                name, args = statement.value.name, statement.value.args
            else:
                continue
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
    arrays = Survey(program, found).array_names
    return tuple(name for name in names if name not in arrays)


def functions_of(structure: Structure) -> dict[str, FunctionText]:
    """Return the program's FUNCTIONs by name."""
    return {
        name: FunctionText(placed.node, placed.at)
        for name, placed in structure.functions.items()
        if isinstance(placed.node, Function)
    }


def in_order(problems: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Sort by place; of several that say the same about one place, the first stays."""
    unique: dict[tuple[int, object], Diagnostic] = {}
    for problem in problems:
        unique.setdefault((problem.code, problem.span or id(problem)), problem)
    return sorted(unique.values(), key=lambda d: d.span or (0, 0))
