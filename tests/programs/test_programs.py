"""Every example and every test program, held to the expectations in its comments, on both back ends."""

from __future__ import annotations

from pathlib import Path

import pytest

from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source
from tests.programs.expectations import read_expectations
from tests.programs.runner import faults_of_program

ROOT = Path(__file__).parents[2]
PROGRAMS = sorted([*ROOT.glob("examples/**/*.src"), *ROOT.glob("tests/programs/**/*.src")])

UNDERSTOOD = {"derivative-spelling"}
"""What other tools write and programs may hold: a check says how the book writes it."""


@pytest.mark.parametrize("path", PROGRAMS, ids=lambda path: str(path.relative_to(ROOT)))
def test_program(path, tmp_path):
    faults = faults_of_program(path.read_text(encoding="utf-8"), tmp_path)
    assert not faults, "\n" + "\n".join(faults)


@pytest.mark.parametrize("path", PROGRAMS, ids=lambda path: str(path.relative_to(ROOT)))
def test_program_expects_something(path):
    expected = read_expectations(path.read_text(encoding="utf-8"))
    assert expected.checks or expected.prints or expected.console or expected.error


@pytest.mark.parametrize("path", PROGRAMS, ids=lambda path: str(path.relative_to(ROOT)))
def test_program_that_works_has_no_problems(path):
    text = path.read_text(encoding="utf-8")
    if path.parent.name == "unreached":
        assert Session().check(Source(text, path.name)), "what is not reached is reported all the same"
    elif read_expectations(text).error is None:
        found = Session().check(Source(text, path.name))
        known = {code for code, _ in read_expectations(text).warnings}
        assert [p for p in found if p.key not in UNDERSTOOD and p.code not in known] == []
