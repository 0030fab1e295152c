"""Lyapunov exponents that are known."""

from __future__ import annotations

import numpy as np
import pytest

import desire_tui
from desire_tui.analysis.signals.lyapunov import dimension
from desire_tui.engine.diagnostics import DesireError

LORENZ = """a = 10 | r = 28 | b = 8/3 | x = 1 | y = 1 | z = 20 | TMAX = 20 | DT = 0.005 | NN = 201 | irule 3
drun
DYNAMIC
d/dt x = a*(y - x)
d/dt y = r*x - y - x*z
d/dt z = x*y - b*z
dispt x
"""
LINEAR = """a = -0.5 | b = 0.25 | x = 1 | y = 1 | TMAX = 4 | DT = 0.01 | NN = 11 | irule 3
drun
DYNAMIC
d/dt x = a*x
d/dt y = b*y + x
dispt x
"""


def test_a_linear_system_has_its_eigenvalues():
    found = desire_tui.lyapunov(LINEAR, "for 40 every 2")
    assert found["exponents"] == pytest.approx([0.25, -0.5], abs=0.02)
    assert found["exponents"].sum() == pytest.approx(-0.25, abs=1e-8)


def test_lorenz():
    """0.9056, 0, -14.572 (Viswanath 1998); the divergence is constant, -(10 + 1 + 8/3)."""
    found = desire_tui.lyapunov(LORENZ, "for 400")
    assert found["exponents"] == pytest.approx([0.9056, 0.0, -14.572], abs=0.06)
    assert found["exponents"].sum() == pytest.approx(-(11 + 8 / 3), rel=1e-6)
    assert found["dimension"] == pytest.approx(2.062, abs=0.005)
    assert np.all(found["margins"] < 0.1)


def test_it_is_stopped():
    told = []

    def progress(part, text, so_far=None):
        told.append(text)
        return so_far is None or len(told) < 4

    found = desire_tui.lyapunov(LORENZ, "for 1e6 every 1", progress=progress)
    assert found.is_partial
    assert len(found["t"]) < 100


def test_dimensions():
    assert dimension(np.array([-1.0, -2.0])) == 0.0
    assert dimension(np.array([0.5, 0.1])) == 2.0
    assert dimension(np.array([0.5, 0.0, -1.0])) == 2.5


@pytest.mark.parametrize("request_", ["for 0", "every -1", "till 3"])
def test_mistakes(request_):
    with pytest.raises(DesireError):
        desire_tui.lyapunov(LINEAR, request_)
