"""Optima that are known exactly."""

from __future__ import annotations

import numpy as np
import pytest

import desire_tui
from desire_tui.analysis.progress import unwatched
from desire_tui.analysis.registry import BY_NAME
from desire_tui.analysis.unknowns import Scale, Unknown
from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.source import Span

STEP = """z = 0.9 | TMAX = 40 | DT = 0.01 | NN = 4001 | x = 0 | v = 0 | J = 0
drun
DYNAMIC
e = 1 - x
d/dt x = v
d/dt v = e - 2*z*v
d/dt J = e*e
dispt x
"""
ROSENBROCK = """a = -1.2 | b = 1 | NN = 2 | TMAX = 1 | DT = 0.5 | x = 0
J = (1 - a)^2 + 100*(b - a^2)^2
drun
DYNAMIC
d/dt x = 1
"""
RASTRIGIN = """a = 3.3 | b = -2.7 | NN = 2 | TMAX = 1 | DT = 0.5 | x = 0 | w = 6.283185307179586
drun
DYNAMIC
d/dt x = 1
J = 20 + a*a - 10*cos(w*a) + b*b - 10*cos(w*b)
"""
THROW = """a = 0.3 | v = 10 | g = 9.81 | TMAX = 3 | DT = 0.01 | NN = 301 | irule 4
x = 0 | y = 0 | u = v*cos(a) | w = v*sin(a)
drun
DYNAMIC
d/dt x = u | d/dt y = w | d/dt w = -g
term -y - 1e-12
dispxy x, y
"""


def test_the_damping_of_the_least_squared_error(subject):
    """ISE of a second-order step response is zeta + 1/(4 zeta): least at 1/2, where it is 1."""
    found = BY_NAME["minimise"].run(subject(STEP), "J over z in [0.1, 2]", unwatched)
    assert found["z"] == pytest.approx(0.5, abs=2e-5)
    assert found["best"] == pytest.approx(1.0, abs=1e-6)
    assert [chart.title for chart in found.charts] == ["J: the least so far", "J along z"]


def test_an_angle_by_the_gradient(subject):
    """Without drag a throw goes farthest at 45 degrees, v^2/g."""
    found = BY_NAME["maximise"].run(subject(THROW), "x over a", unwatched)
    assert found["a"] == pytest.approx(np.pi / 4, abs=1e-6)
    assert found["best"] == pytest.approx(100 / 9.81, rel=1e-6)
    assert found["runs"] < 200


@pytest.mark.parametrize("way", ["", " by cma", " by cma seed 3"])
def test_a_narrow_valley_of_what_the_script_computes(subject, way):
    found = BY_NAME["minimise"].run(subject(ROSENBROCK), f"J over a, b{way}", unwatched)
    assert (found["a"], found["b"]) == pytest.approx((1.0, 1.0), abs=1e-5)


def test_many_valleys(subject):
    asked = "J over a in [-5.12, 5.12], b in [-5.12, 5.12]"
    nearest = BY_NAME["minimise"].run(subject(RASTRIGIN), asked, unwatched)
    assert nearest["best"] > 1.0, "a local search stays in the valley where it begins"
    found = BY_NAME["minimise"].run(subject(RASTRIGIN), f"{asked} by global", unwatched)
    assert (found["a"], found["b"], found["best"]) == pytest.approx((0.0, 0.0, 0.0), abs=1e-6)


def test_a_corner_that_has_no_slope(subject):
    text = RASTRIGIN.replace("J = 20", "J = abs(a - 1.25) + abs(b + 0.5)\nK = 20")
    found = BY_NAME["minimise"].run(subject(text), "J over a, b", unwatched)
    assert (found["a"], found["b"]) == pytest.approx((1.25, -0.5), abs=1e-5)


def test_a_bound_is_said(subject):
    found = BY_NAME["minimise"].run(subject(STEP), "J over z in [0.6, 2]", unwatched)
    assert found["z"] == pytest.approx(0.6, abs=1e-9)
    assert found.notes == ["z stands at its bound 0.6"]


def test_a_logarithmic_scale(subject):
    found = BY_NAME["minimise"].run(subject(STEP), "J over z = 50 in [0.001, 100] log", unwatched)
    assert found["z"] == pytest.approx(0.5, abs=1e-4)


def test_it_is_stopped_and_tells_what_it_has(subject):
    told = []

    def progress(part, text, so_far):
        told.append(so_far["best"])
        return len(told) < 4

    found = BY_NAME["minimise"].run(subject(ROSENBROCK), "J over a, b", progress)
    assert found.is_partial
    assert found["best"] <= told[1]
    assert len(found.charts) == 1


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ("J", "the request ends where 'over' is expected"),
        ("J over", "the request ends where the name of a quantity to vary is expected"),
        ("J over a, a", "'a' is given twice"),
        ("J over a in [2, 1]", "the interval from 2 to 1 holds nothing"),
        ("J over a = 3 in [0, 1]", "a begins at 3, outside its bounds [0, 1]"),
        ("J over a in [0, 1] log", "a logarithmic scale has no 0"),
        ("J over a by golbal", "'golbal' is no way to search"),
        ("J over a by global", "a global search needs bounds of a"),
        ("J over a runs 1.5", "1.5 is no whole number from 1 on"),
        ("x@0:1:0.5 over a", "'x@0:1:0.5' is not one number of a run"),
        ("x over a", "x does not change with a where the search begins"),
        ("J over q", "'q' is set from outside, but the program has no 'q'"),
        ("a/0 over a", "there is no a/0 where the search begins, at a = -1.2: a/0 is"),
    ],
)
def test_mistakes(asked, message):
    with pytest.raises(DesireError) as error:
        desire_tui.minimise(ROSENBROCK, asked)
    assert error.value.diagnostics[0].message.startswith(message)


def test_a_scale_gives_back_its_values():
    place = Span(0, 1)
    unknowns = [Unknown("a", place), Unknown("b", place, None, 1.0, 100.0, is_log=True),
                Unknown("c", place, None, 0.0, np.inf), Unknown("d", place, None, -2.0, 4.0)]  # fmt: skip
    start = np.array([0.0, 10.0, 5.0, 1.0])
    scale = Scale(unknowns, start)
    assert scale.values(scale.start) == pytest.approx(start)
    assert scale.start == pytest.approx([0.0, 0.5, 0.0, 0.5])
    assert scale.values(np.array([0.0, 1.0, -1.0, 1.0])) == pytest.approx([0.0, 100.0, 0.0, 4.0])
