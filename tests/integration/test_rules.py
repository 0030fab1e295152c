"""The table of integration rules: complete, consistent, and asked by everybody who is given a rule's number."""

from __future__ import annotations

import re

import pytest

from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.diagnostics.wording import all_wordings
from desire_tui.engine.integration.pattern import Pattern
from desire_tui.engine.integration.plan import is_own, plan
from desire_tui.engine.integration.rules import (
    MOST_USED_FIRST,
    RULES,
    in_words,
    markdown_table,
    rule_numbered,
    rules_of,
    with_corrector,
)
from desire_tui.engine.integration.tableaus import TABLEAUS
from desire_tui.engine.lowering.lowering import lower
from desire_tui.engine.runtime.defaults import Defaults
from desire_tui.engine.session.compiled_segments import make_backend
from desire_tui.engine.session.listener import Listener
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source
from desire_tui.engine.syntax.parse import parse
from desire_tui.engine.values import Values
from desire_tui.help.page_catalogue import topics
from tests.integration.stiff_programs import failure

PROGRAM = "TMAX = 1 | DT = 0.1 | NN = 11 | x = 1\ndrun\nDYNAMIC\nd/dt x = -x\ndispt x\n"


def session_after_a_run(backend="native"):
    session = Session(Listener(), backend=backend)
    session.erun(Source(PROGRAM, "test.src"))
    return session


def test_the_numbers_and_kinds():
    assert rules_of("dummy") == (0,)
    assert rules_of("fixed") == (1, 2, 3, 5)
    assert rules_of("variable") == (4, 7, 8)
    assert rules_of("multistep") == tuple(range(9, 17))
    assert rules_of("series") == (17,)
    assert len(RULES) == 17
    assert all(RULES[number].number == number for number in RULES)


def test_explicit_rules_have_a_tableau_that_agrees_with_the_table():
    assert {number for number, rule in RULES.items() if rule.solver == "tableau"} == TABLEAUS.keys()
    for number, tableau in TABLEAUS.items():
        rule = RULES[number]
        assert tableau.rule is rule
        assert tableau.stages == rule.stages
        assert tableau.variable == (rule.kind == "variable")


def test_loops_are_warmed_for_every_rule_with_a_loop_of_its_own():
    assert sorted(MOST_USED_FIRST) == sorted(rules_of("dummy", "fixed", "variable"))


def test_cvode_has_two_methods_with_four_correctors_each():
    pairs = [(RULES[number].solver, RULES[number].corrector) for number in rules_of("multistep")]
    ways = ("fixed-point", "jacobian", "differences", "diagonal")
    assert pairs == [(solver, way) for solver in ("Adams", "BDF") for way in ways]
    assert with_corrector(RULES[12], "differences").number == 11
    assert with_corrector(RULES[16], "differences").number == 15


def test_our_own_solver_is_for_small_systems_under_14_and_15():
    full = Pattern.full(3)
    assert [n for n in rules_of("multistep") if is_own(n, 3, plan(n, full))] == [14, 15]


BY_WHOM = {
    "irule": lambda number: failure(f"irule {number}\n" + PROGRAM)[1],
    "compare": lambda number: session_after_a_run().execute(f"compare rule {number}"),
    "native": lambda number: _model("native", number),
    "reference": lambda number: _model("reference", number),
    "defaults": lambda number: _plan(number),  # noqa: PLW0108 - defined below
    "solver": lambda number: plan(number, Pattern.full(2)),
}


def _segment():
    values = Values()
    values.assign(values.scalar("x").slot, 1.0)
    return lower(parse(Source(PROGRAM)), None, values), values


def _model(backend, number):
    segment, values = _segment()
    make_backend(backend).model(segment, number, values)


def _plan(number):
    segment, values = _segment()
    Defaults(values).plan(segment, number, Source(PROGRAM), None)


@pytest.mark.parametrize("number", [6, 18, -1])
@pytest.mark.parametrize("by", BY_WHOM)
def test_a_made_up_rule_is_refused_everywhere_by_the_same_message(by, number):
    try:
        problem = BY_WHOM[by](number)
    except DesireError as error:
        problem = error.diagnostics[0]
    assert (problem.code, problem.message) == (86, f"there is no integration rule {number}")


@pytest.mark.parametrize("number", [6, 4.5, float("nan"), float("inf")])
def test_no_rule_is_made_of_other_numbers(number):
    with pytest.raises(DesireError):
        rule_numbered(number)


def test_numbers_in_words():
    assert in_words((4, 7, 8)) == "4, 7, 8"
    assert in_words(rules_of("multistep")) == "9 … 16"
    assert in_words(tuple(RULES)) == "0 … 5, 7 … 17"


def test_messages_name_the_rules_of_the_table():
    """Messages stand below the table and cannot read it."""
    wording = all_wordings()
    assert wording["no-such-rule"].hint == f"rules are {in_words(tuple(RULES)).replace(', ', ' and ')}"
    *first, last = map(str, rules_of("fixed"))
    fixed = f"{', '.join(first)} or {last}"
    assert wording["delay-variable-step"].hint.startswith(f"use irule {fixed},")
    cvode = tuple(number for number in rules_of("multistep") if not RULES[number].has_own_solver)
    for key in ("solver-missing", "solver-version"):
        assert wording[key].message.startswith(
            f"rules {in_words(cvode).replace('…', 'to').replace(', ', ' and ')} need"
        )


def test_the_help_page_is_made_from_the_table():
    page = topics()["irule"].text
    assert markdown_table() in page
    assert "Rules 9–16 want `ERMAX`" in page
    assert not any(
        re.search(r"\{[^}]*rules[^}]*\}", topic.text + topic.summary) for topic in topics().values()
    )
