"""Runs a program on both back ends and returns everything that is not as its comments say."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tests.programs.checking import check, disagreements
from tests.programs.execution import execute
from tests.programs.expectations import read_expectations

if TYPE_CHECKING:
    from pathlib import Path

    from desire_tui.engine.diagnostics import Diagnostic
    from tests.programs.execution import Outcome
    from tests.programs.expectations import Expectations


def faults_of_program(text: str, folder: Path) -> list[str]:
    """Check the native back end against all expectations, and the reference back end against the native one."""
    expected = read_expectations(text)
    how = {"go": expected.go, "answers": expected.answers}
    faults: list[str] = []
    native = {
        variant: execute(text, "native", folder, settings=variant, **how)
        for variant in dict.fromkeys([(), *expected.variants])
    }
    faults += _faults(expected, native)
    if expected.reference not in native:
        native[expected.reference] = execute(text, "native", folder, settings=expected.reference, **how)
    reference = execute(text, "reference", folder, settings=expected.reference, **how)
    faults += [
        f"back ends: {fault}" for fault in disagreements(native[expected.reference], reference, expected)
    ]
    return faults


def _faults(expected: Expectations, outcomes: dict) -> list[str]:
    plain: Outcome = outcomes[()]
    found = _wrong_error(expected, plain)
    given = [(problem.code, _row(problem)) for problem in plain.warnings]
    for code, row in expected.warnings:
        count = sum(code == other and row in (None, at) for other, at in given)
        if count != 1:
            found.append(f"warning {code} at {row}: given {count} times; all are {given}")
    found += [fault for c in expected.checks if (fault := check(c, outcomes[c.settings])) is not None]
    found += [
        f"not printed: {text!r} in {plain.console!r}" for text in expected.prints if text not in plain.console
    ]
    if expected.console is not None and plain.console.rstrip("\n") != "\n".join(expected.console):
        found.append(f"console: {plain.console!r}")
    return found


def _wrong_error(expected: Expectations, outcome: Outcome) -> list[str]:
    """Compare the error that ended the program with the one expected."""
    wanted = expected.error
    if outcome.error is None:
        return [f"error {wanted[0]} did not come"] if wanted else []
    problem = outcome.error.diagnostics[0]
    row = _row(problem)
    if wanted is not None and problem.code == wanted[0] and wanted[1] in (None, row):
        return []
    return [f"line {row}: error {problem.code}: {problem.message}"]


def _row(problem: Diagnostic) -> int | None:
    return problem.source.position(problem.span.start).row if problem.source and problem.span else None
