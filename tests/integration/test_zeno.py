"""Events that come ever sooner, without end in a finite time: a message under every rule, never a missed one.

A ball let fall from h bounces for √(2h/g)·(1 + r)/(1 - r), as a geometric series, r of its speed being kept.
"""

from __future__ import annotations

from math import sqrt

import pytest

from desire_tui.engine.codegen.compiler_state import shared_state
from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.integration.rules import RULES
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source

EULER = 2
"""Its bounces gain energy, as much as the size of DT, and do not end (tests/programs/errors)."""
STEPPED = sorted(rule for rule in RULES if RULES[rule].kind != "dummy" and rule != EULER)
BALL = """h = 50 | v = 0 | n = 0 | on = 1
TMAX = 100 | DT = 0.01 | NN = 101 | ERMAX = 1e-6 | irule {rule}
drun
DYNAMIC
d/dt h = v
d/dt v = -9.81*on
dispt h
event -h
v = -{kept}*v | n = n + 1{caught}
"""
TOO_FAST, NEAR = 486, 2e-3


def number(session, name):
    """Return a quantity's number."""
    return session.values.cells[session.values.find(name).slot]


def after(rule, kept, caught="", backend="native"):
    """Return the session after the ball's run, and the error that ended it."""
    session = Session(backend=backend, compiler=shared_state() if backend == "native" else None)
    try:
        session.erun(Source(BALL.format(rule=rule, kept=kept, caught=caught)))
    except DesireError as error:
        return session, error.diagnostics[-1]
    return session, None


@pytest.mark.parametrize("rule", STEPPED)
@pytest.mark.parametrize("kept", [0.2, 0.5, 0.8])
def test_bounces_without_end_are_told_where_they_pile_up(rule, kept):
    session, error = after(rule, kept)
    assert error is not None
    assert error.code == TOO_FAST
    end = sqrt(2 * 50 / 9.81) * (1 + kept) / (1 - kept)
    assert number(session, "t") == pytest.approx(end, rel=NEAR)


@pytest.mark.parametrize("rule", [3, 14, 17])
def test_the_reference_tells_it_at_the_same_moment(rule):
    native, reference = (after(rule, 0.5, backend=backend)[0] for backend in ("native", "reference"))
    assert number(native, "t") == pytest.approx(number(reference, "t"), rel=1e-7)


@pytest.mark.parametrize("rule", [1, 3, 4, 8, 9, 14, 16, 17])
def test_a_ball_that_is_caught_stays_where_it_is(rule):
    session, error = after(rule, 0.8, "\non = swtch(v - 0.01) | v = on*v")
    assert error is None
    assert number(session, "n") == pytest.approx(36, abs=1.5)
    assert number(session, "h") == pytest.approx(0, abs=1e-5)


@pytest.mark.parametrize("rule", [3, 4, 9, 14, 17])
def test_ever_sooner_by_itself_is_no_reason_to_end(rule):
    chirp = (
        "n = 0 | q = 0 | TMAX = 20 | DT = 0.001 | NN = 201 | ERMAX = 1e-6 | irule {rule}\ndrun\nDYNAMIC\n"
        "d/dt q = 2*t*cos(t*t)\ndispt q\nevent q + 0.1*t\nn = n + 1\n"
    )
    session = Session(compiler=shared_state())
    session.erun(Source(chirp.format(rule=rule)))
    assert number(session, "n") == 17  # sin(t*t) = -t/10 rising, t < 10, and at once
