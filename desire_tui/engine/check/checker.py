"""Every problem of a program that can be found before it runs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.cancellation import OutOfTime, handing_over
from desire_tui.engine.check.declared import DeclaredNames
from desire_tui.engine.check.foreign_forms import foreign_forms
from desire_tui.engine.check.rules import known_rule
from desire_tui.engine.check.series import without_series
from desire_tui.engine.check.unknown import misplaced, unknown_names
from desire_tui.engine.check.uses import unfit_uses
from desire_tui.engine.diagnostics.spelling import few_hints
from desire_tui.engine.gc_pause import undisturbed_allocation
from desire_tui.engine.lowering.lowering import functions_of, in_order, without_consequences
from desire_tui.engine.lowering.segments import lower_segment
from desire_tui.engine.structure.structure import structure as find_structure

if TYPE_CHECKING:
    from desire_tui.engine.diagnostics import Diagnostic
    from desire_tui.engine.nodes.program import Program


@undisturbed_allocation
@few_hints()
def check(program: Program) -> tuple[Diagnostic, ...]:
    """Return all problems that can be found before a run, in the order of the text.

    They come from syntax, structure and segments. A name counts as defined if any script statement before the
    segment's first `drun` could assign it; sizes that the script computes are not checked.
    """
    try:
        problems = _all_problems(program)
    except OutOfTime as end:
        end.found = _without_echoes(end.found, program)
        raise
    return tuple(_without_echoes(problems, program))


def _all_problems(program: Program) -> list[Diagnostic]:
    problems, at = list(program.problems), 0
    with handing_over(problems, lambda: at):
        found = find_structure(program)
        problems += [*found.problems, *misplaced(program, found)]
        survey = DeclaredNames(program, found)
        problems += survey.names_taken
        functions = functions_of(found)
        for text in program.segments:
            at = text.at
            scope = survey.scope_for(text)
            rule = known_rule(program.script, text.label)
            segment, of_it = lower_segment(text, scope, program.source, functions, found, rule)
            problems.extend(of_it)
            if not of_it:
                problems.extend(segment.warnings)
                problems.extend(without_series(segment, rule, survey.quantities.values()))
        at = len(program.source.text)
        problems.extend(unknown_names(program, found, survey.everything, survey.array_names))
        problems.extend(unfit_uses(program, found))
        problems.extend(foreign_forms(program))
    return problems


def _without_echoes(problems: list[Diagnostic], program: Program) -> list[Diagnostic]:
    """Leave out names that seem to be missing because their lines are wrong."""
    return in_order(without_consequences(problems, program, problems))
