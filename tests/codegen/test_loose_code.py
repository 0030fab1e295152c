"""`fast`: the same results to rounding, and strict code beside it that keeps its bits."""

from __future__ import annotations

import numpy as np
import pytest

import desire_tui
from desire_tui.engine.codegen.jit.loose_code import loosened
from desire_tui.engine.codegen.jit.piece import Piece

MODEL = """a = 10 | r = 28 | b = 8/3 | x = 1 | y = 1 | z = 20 | TMAX = 2 | DT = 0.01 | NN = 51 | irule {rule}
drun
DYNAMIC
{fast}
d/dt x = a*(y - x)
d/dt y = r*x - y - x*z
d/dt z = x*y - b*z
dispt x, y
"""


def test_only_a_pieces_own_arithmetic_is_freed():
    text = "define i32 @p(ptr %m) {\n%a = fadd double %x, %y\n%b = fcmp ogt double %a, %y\n%c = fneg <4 x double> %v\n}"
    free = loosened(Piece("p", text, frozenset({"declare double @q(double)"})))
    assert free.name == "p.loose"
    assert "@p.loose(ptr %m)" in free.text
    assert "%a = fadd contract reassoc nsz arcp double %x, %y" in free.text
    assert "%b = fcmp ogt double" in free.text
    assert "%c = fneg contract reassoc nsz arcp <4 x double> %v" in free.text
    assert free.needs == {"declare double @q(double)"}


@pytest.mark.parametrize("rule", [1, 3, 4, 8, 9, 15, 17])
def test_the_same_to_rounding_under_every_kind_of_rule(rule):
    loose = desire_tui.load(MODEL.format(rule=rule, fast="fast")).run()
    strict = desire_tui.load(MODEL.format(rule=rule, fast="")).run()
    assert loose["x"] == pytest.approx(strict["x"], abs=2e-2 if rule > 4 else 1e-9)
    again = desire_tui.load(MODEL.format(rule=rule, fast="")).run()
    assert np.array_equal(again["x"], strict["x"])


def test_infinities_are_still_found():
    run = desire_tui.load(
        "x = 1 | TMAX = 5 | DT = 0.01 | NN = 51\ndrun\nDYNAMIC\nfast\nd/dt x = x*x\ndispt x\n"
    ).run()
    assert run.error is not None
    assert run.error.diagnostics[0].code == 3
