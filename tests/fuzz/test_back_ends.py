"""What the comparison of the back ends excuses, and what it does not."""

from __future__ import annotations

from unittest.mock import patch

import pytest

from desire_tui.engine.reference.model import ReferenceModel
from desire_tui.engine.reference.stiff import StiffReferenceModel
from tests.fuzz import back_ends
from tests.fuzz.back_ends import check

PROGRAM = """\
irule {rule} | ERMAX = 1e-6 | DT = 0.01 | TMAX = 1 | NN = 11
x = 1
drun
DYNAMIC
d/dt x = {right}
dispt x
"""
SMOOTH = "sin(3*t) - x"
CHAOTIC = "1e9*sin(1e9*x) - x"
"""A rounding of x decides where it goes."""
RULES = (4, 9, 14, 15)


@pytest.fixture
def wrong_reference():
    """Derivatives that are wrong by 1e-4: what a fault may do, and roundings do not."""
    make_pass, derivatives = ReferenceModel._pass, StiffReferenceModel.derivatives

    def wrong_pass(self, statements, memory):
        make_pass(self, statements, memory)
        self.states.k[0] *= 1 + 1e-4

    def wrong_derivatives(self, t, y, out):
        derivatives(self, t, y, out)
        out *= 1 + 1e-4

    with (
        patch.object(ReferenceModel, "_pass", wrong_pass),
        patch.object(StiffReferenceModel, "derivatives", wrong_derivatives),
    ):
        yield


@pytest.mark.parametrize("rule", RULES)
def test_sound_back_ends_agree(rule):
    check(PROGRAM.format(rule=rule, right=SMOOTH))


@pytest.mark.usefixtures("wrong_reference")
@pytest.mark.parametrize("rule", [*RULES, 1, 3])
def test_a_small_fault_is_seen(rule):
    with pytest.raises(AssertionError, match="differs by"):
        check(PROGRAM.format(rule=rule, right=SMOOTH))


@pytest.mark.usefixtures("wrong_reference")
def test_what_roundings_decide_is_excused():
    check(PROGRAM.format(rule=4, right=CHAOTIC).replace("ERMAX = 1e-6", "ERMAX = 1e30"))


def test_a_run_without_end_is_ended(monkeypatch):
    monkeypatch.setattr(back_ends, "SECONDS", 0.5)
    check(PROGRAM.format(rule=3, right=SMOOTH).replace("TMAX = 1 ", "TMAX = 1e9 "))


def test_what_a_steep_function_makes_of_roundings_is_excused():
    text = (
        "ARRAY K[2,2], W[2,2]\nNN = 60 | W[1,2] = 0.7 | K[2,1] = 0.3\ndrun\nDYNAMIC\nMATRIX K = tan(W + K)\n"
    )
    check(text + "MATRIX W = 0.9*W + 0.01*sin(3*W)\ny = K[1,2]\ndispt y\n")
