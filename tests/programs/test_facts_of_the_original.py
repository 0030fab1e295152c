"""Every fact about programs of the original has three programs of our own that hold it."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.programs.expectations import read_expectations
from tests.programs.facts_of_the_original import FACTS

HERE = Path(__file__).parent
COMMANDS = (HERE.parent / "session/test_older_spellings_as_commands.py").read_text(encoding="utf-8")
MESSAGES = "".join(path.read_text(encoding="utf-8") for path in sorted(HERE.parent.glob("messages/*/*.txt")))
LEAST = 3


@pytest.mark.parametrize("fact", FACTS, ids=lambda fact: fact.title)
def test_a_fact_has_programs(fact):
    assert len(set(fact.programs)) >= LEAST
    for name in fact.programs:
        text = (HERE / f"{name}.src").read_text(encoding="utf-8")
        assert re.search(fact.form, text, re.MULTILINE), name
        expected = read_expectations(text)
        assert expected.checks or expected.prints or expected.console or expected.error, name
    assert fact.command in COMMANDS


@pytest.mark.parametrize("fact", FACTS, ids=lambda fact: fact.title)
def test_where_it_is_really_wrong_a_message_points(fact):
    assert re.search(rf"^    {re.escape(fact.wrong)}\n +\^", MESSAGES, re.MULTILINE)


def test_each_shared_program_stands_for_a_fact():
    shared = {path.stem for path in (HERE / "original").glob("*.src")}
    assert {name for fact in FACTS for name in fact.first} == shared
