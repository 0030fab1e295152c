"""Distributions, averages and sections whose answer is known."""

from __future__ import annotations

import numpy as np
import pytest

import desire_tui
from desire_tui.analysis.signals.distribution import correlation_time
from desire_tui.engine.diagnostics import DesireError

CIRCLE = """w = 2 | x = 0 | y = 1 | TMAX = 20 | DT = 0.02 | NN = 1001 | irule 8 | ERMAX = 1e-10
drun
DYNAMIC
d/dt x = w*y
d/dt y = -w*x
z = t/20
dispt x
"""
DUFFING = """d = 0.3 | g = 0.5 | w = 1.2 | x = 1 | v = 0 | TMAX = 100 | DT = 0.01 | NN = 1001 | irule 8 | ERMAX = 1e-9
drun
DYNAMIC
d/dt x = v
d/dt v = x - x^3 - d*v + g*cos(w*t)
dispt x
"""
LORENZ = """a = 10 | r = 28 | b = 8/3 | x = 1 | y = 1 | z = 20 | TMAX = 50 | DT = 0.01 | NN = 2501
drun
DYNAMIC
d/dt x = a*(y - x)
d/dt y = r*x - y - x*z
d/dt z = x*y - b*z
dispt x
"""


def test_a_uniform_distribution():
    found = desire_tui.histogram(CIRCLE, "z bins 10")
    assert found["z"]["density"] == pytest.approx(np.ones(10), rel=0.02)
    table = found.tables[0].columns
    assert table["50 %"] == pytest.approx([0.5], abs=1e-3)
    assert table["5 %"] == pytest.approx([0.05], abs=1e-3)


def test_a_constant_has_a_distribution_too():
    found = desire_tui.histogram(CIRCLE.replace("z = t/20", "z = 7"), "z")
    assert found.tables[0].columns["least"] == [7.0]


def test_the_mean_of_correlated_samples():
    """An AR(1) sequence with coefficient a has the correlation time (1 + a)/(1 - a)."""
    random = np.random.default_rng(3)
    noise, x = random.standard_normal(200_000), np.zeros(200_000)
    for k in range(1, len(x)):
        x[k] = 0.8 * x[k - 1] + noise[k]
    assert correlation_time(x) == pytest.approx(9.0, rel=0.06)
    assert correlation_time(noise) == pytest.approx(1.0, abs=0.05)
    assert correlation_time(np.full(10, 3.0)) == 1.0


def test_averages_of_a_circle():
    """Over whole turns the mean is 0 and the rms 1/sqrt(2)."""
    found = desire_tui.average(
        CIRCLE.replace("TMAX = 20 | DT = 0.02", f"TMAX = {4 * np.pi} | DT = 0.01"), "x, z"
    )
    assert found["x"]["mean"] == pytest.approx(0.0, abs=2e-3)
    assert found["x"]["rms"] == pytest.approx(np.sqrt(0.5), abs=1e-3)
    assert "too few for its interval" in found.notes[0]


@pytest.mark.parametrize(("way", "first"), [("up", np.pi), ("down", np.pi / 2), ("both", np.pi / 2)])
def test_passages_are_located(way, first):
    """x = sin(2 t): upwards at whole multiples of pi."""
    found = desire_tui.section(CIRCLE, f"x = 0 {way} of y")
    step = np.pi if way != "both" else np.pi / 2
    assert found["t"] == pytest.approx(first + step * np.arange(len(found["t"])), abs=1e-7)
    assert len(found["t"]) == int((20 - first) / step) + 1
    assert np.abs(found["x"]).max() < 1e-9


def test_a_period_apart():
    found = desire_tui.section(CIRCLE, f"every {np.pi}")
    assert found["t"] == pytest.approx(np.pi * np.arange(7))
    assert found["y"] == pytest.approx(np.ones(7), abs=1e-7)


def test_a_fixed_point_of_a_driven_oscillator():
    """After the transient the small orbit of Duffing's equation comes back after one period of the force."""
    text = DUFFING.replace("g = 0.5", "g = 0.1")
    found = desire_tui.section(text, "every 5.235987755982989 from 60 points 25")
    assert len(found["t"]) == 25
    assert np.ptp(found["x"][-5:]) < 1e-6


def test_lorenz_map_has_a_cusp():
    """Successive maxima of z fall on one curve (Lorenz 1963): passages x = y, where z turns... by z = r - 1."""
    found = desire_tui.section(LORENZ, "z = 27 down of x from 5 points 60")
    assert len(found["t"]) == 60
    assert found.charts[-1].title == "Return map at z = 27"
    assert len(found.charts[-1].series[0].x) == 59


@pytest.mark.parametrize(
    ("call", "request_", "message"),
    [
        ("histogram", "x bins 0", "0 is no whole number from 1 on"),
        ("average", "x from 30", "the run has 0 samples from t = 30 on: too few to say anything"),
        ("section", "q = 0", "'q' is no state"),
        ("section", "x = 5", "the run never passed there"),
        ("section", "x = 5 points 3", "10 runs never passed there"),
        ("section", "every -1", "a period is greater than 0"),
        ("section", "x = 0 of q", "'q' is no state"),
    ],
)
def test_mistakes(call, request_, message):
    with pytest.raises(DesireError) as error:
        getattr(desire_tui, call)(CIRCLE, request_)
    assert error.value.diagnostics[0].message == message
