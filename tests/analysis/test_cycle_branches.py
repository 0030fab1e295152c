"""Where branches of cycles cross and double, and curves of such points over two parameters.

Against models whose cycles can be written down.
"""

from __future__ import annotations

import numpy as np
import pytest

from desire_tui.analysis.continuation.collocation import node_times
from desire_tui.analysis.continuation.cycle_event_curve import CycleEventCurve
from desire_tui.analysis.continuation.equilibrium_curve import Range
from desire_tui.analysis.equilibria.flow import Flow
from desire_tui.analysis.equilibria.system import System
from desire_tui.analysis.subject import Subject
from desire_tui.engine.source import Source

from .test_continuation import diagram, points, told

# a circle that is turned once in 2π, and a third state that leaves its plane: z = ±√mu, or z = mu
OUT_OF_PLANE = """mu = -0.1 | q = 0 | x = 1 | y = 0 | z = 1 | TMAX = 7 | DT = 0.01 | NN = 11
drun
DYNAMIC
r = x*x + y*y
d/dt x = x*(1 - r) - y
d/dt y = y*(1 - r) + x
d/dt z = mu*z - q*z*z - (1 - q)*z*z*z
dispxy x, z
"""
# r' = r (a + b r² - r⁴): cycles meet where a = -b²/4, and vanish where a = 0
TWO_CIRCLES = """a = -0.2 | b = 1 | x = 0.9 | y = 0 | TMAX = 7 | DT = 0.01 | NN = 11
drun
DYNAMIC
r = x*x + y*y
d/dt x = x*(a + b*r - r*r) - y
d/dt y = y*(a + b*r - r*r) + x
dispxy x, y
"""
# beside a circle, deviations turn by half while it is gone round (a Möbius band): multipliers are
# -exp(2π(k - q²)) and -exp(-2πc)
MOEBIUS = """k = -0.1 | q = 0.3 | c = 0.3 | x = 1.1 | y = 0 | z = 0 | TMAX = 7 | DT = 0.01 | NN = 11
drun
DYNAMIC
r = sqrt(x*x + y*y) | u = r - 1 | cs = x/r | sn = y/r
s = (k - q*q - c)/2 | d = (k - q*q + c)/2 | n = u*u + z*z
du = (s + d*cs - n)*u + (d*sn - 0.5)*z
d/dt z = (d*sn + 0.5)*u + (s - d*cs - n)*z
d/dt x = du*cs - y
d/dt y = du*sn + x
dispxy x, y
"""


@pytest.mark.parametrize(("q", "shape"), [(0, "pitchfork"), (1, "transcritical")])
def test_the_other_branch_at_a_branch_point_is_followed(q, shape):
    found = diagram(OUT_OF_PLANE.replace("q = 0", f"q = {q}"), "mu in [-0.15, 0.1] from cycle")
    assert [p["kind"] for p in found["points"]] == ["branch point of cycles"]
    assert found["points"][0]["mu"] == pytest.approx(0.0, abs=1e-8)
    others = [b for b in found["branches"] if b["from"] == "branch point of cycles 1"]
    assert sorted(float(np.sign(b["z"][-1])) for b in others) == [-1.0, 1.0]
    for branch in others:
        mu, z = branch["mu"], branch["z"]
        assert np.abs(z) == pytest.approx(np.sqrt(mu) if shape == "pitchfork" else np.abs(mu), abs=1e-6)
        assert np.all(branch["stable"] == (shape == "pitchfork" or mu > 0))
        assert min(abs(mu[-1] - 0.1), abs(mu[-1] + 0.15)) < 1e-9
    for branch in [b for b in found["branches"] if b["from"] == "run"]:
        apart = np.abs(branch["mu"]) > 1e-3
        assert np.all(branch["stable"][apart] == (branch["mu"][apart] < 0))


def test_folds_of_cycles_over_two_parameters():
    found = diagram(TWO_CIRCLES, "a in [-0.31, -0.19], b in [0.9, 1.1] from cycle fold of cycles 1")
    (curve,) = found["branches"]
    assert (curve["of"], curve["from"]) == ("fold of cycles", "fold of cycles 1")
    assert curve["a"] == pytest.approx(-(curve["b"] ** 2) / 4, abs=1e-9)
    assert {round(float(b), 9) for b in (curve["b"].min(), curve["b"].max())} == {0.9, 1.1}
    assert curve["period"] == pytest.approx(2 * np.pi, rel=1e-7)
    assert found.charts[0].title == "Folds of cycles over a and b"


def test_period_doublings_over_two_parameters():
    found = diagram(MOEBIUS, "k in [-0.11, 0.1], q in [0.25, 0.35] from cycle period doubling 1")
    (curve,) = found["branches"]
    assert (curve["of"], curve["from"]) == ("period doubling", "period doubling 1")
    assert curve["k"] == pytest.approx(curve["q"] ** 2, abs=1e-9)
    assert curve["q"].min() == pytest.approx(0.25)
    assert curve["k"].max() == pytest.approx(0.1)


def test_cycles_end_where_they_shrink_to_a_hopf_point():
    found = diagram(TWO_CIRCLES, "a in [-0.3, 0.1] from cycle")
    assert points(found, "fold of cycles", "a") == pytest.approx([-0.25], abs=1e-9)
    ends = [b["a"][-1] for b in found["branches"]]
    assert ends == pytest.approx([0.1, 0.0], abs=1e-4)
    assert "Hopf" in str(found)


@pytest.mark.parametrize("event", ["fold of cycles", "period doubling"])
def test_derivatives_of_the_equation_of_the_event(event):
    subject = Subject(Source(TWO_CIRCLES, "test.src"))
    system = System(Flow(subject), np.ones(2), np.ones(2))
    mesh = np.linspace(0.0, 1.0, 11)
    angle = 2 * np.pi * node_times(mesh)
    nodes = np.column_stack([np.cos(angle), np.sin(angle)]) * 0.7 + 0.01 * np.sin(3 * angle)[:, None]
    curve = CycleEventCurve(system, (Range("a", -1, 1), Range("b", 0, 2)), mesh, nodes, event)
    u = np.concatenate([nodes.ravel(), [np.log(2 * np.pi), 0.37, 0.5]])
    exact = curve.matrix(u).toarray()
    for k in (0, 5, 40, len(u) - 3, len(u) - 2, len(u) - 1):
        step = 1e-5 * np.eye(len(u))[k]
        difference = (curve.residual(u + step) - curve.residual(u - step)) / 2e-5
        assert exact[:, k] == pytest.approx(difference, abs=1e-7)


@pytest.mark.parametrize(
    ("request_", "words"),
    [
        ("a in [-0.4, -0.1], b in [0.8, 1.2] from fold of 1", "'1' stands where 'cycles' is expected"),
        ("a in [-0.4, -0.1], b in [0.8, 1.2] from here", "folds of cycles and period doublings are"),
        ("a in [-0.4, -0.1] from period doubling 1", "continued over two parameters"),
    ],
)
def test_what_cannot_be_followed_says_why(request_, words):
    assert words in told(TWO_CIRCLES, request_)
