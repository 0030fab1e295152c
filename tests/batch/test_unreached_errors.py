"""Errors that a program does not reach: it runs, and a warning says how many there are."""

from __future__ import annotations

import pytest

import desire_tui

PROGRAM = "write 'a'\nif 1 > 2 then\nx = (3\ngo to nowhere\nproceed\nwrite 'b'\n"


@pytest.mark.parametrize("backend", ["native", "reference"])
def test_a_warning_counts_what_was_not_reached(backend):
    result = desire_tui.run(PROGRAM, backend=backend)
    assert (result.status, result.console) == ("done", "a\nb\n")
    (problem,) = result.problems
    assert (problem.severity, problem.code) == ("warning", 412)
    assert problem.message == "2 errors stand where the program did not come"


def test_an_error_that_is_reached_comes_first_and_the_others_behind_it():
    result = desire_tui.run(PROGRAM.replace("write 'b'", "y = [3"))
    assert (result.status, result.console) == ("failed", "a\n")
    assert [(p.code, p.line) for p in result.problems] == [(25, 6), (7, 3), (68, 4)]


def test_text_that_is_no_statement_stops_the_program_at_once():
    result = desire_tui.run(PROGRAM.replace("x = (3", "no statement at all"))
    assert (result.status, result.console) == ("failed", "")
    assert [(p.code, p.line) for p in result.problems] == [(1, 3), (68, 4)]
