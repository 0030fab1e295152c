"""Linear systems near a place, against what is known of them by hand and by python-control."""

from __future__ import annotations

import numpy as np
import pytest

import desire_tui
from desire_tui.analysis.progress import unwatched
from desire_tui.analysis.registry import BY_NAME
from desire_tui.engine.diagnostics import DesireError

SERVO = """u = 0 | gain = 200 | r = 26 | mx = 0.85 | g2 = 2 | R = 0.6 | TMAX = 5 | DT = 0.001 | NN = 501
drun
DYNAMIC
error = x - u
V = -gain*error - r*xdot
torque = mx*tanh(g2*V/mx)
d/dt x = xdot
d/dt xdot = torque - R*xdot
output = 2*x + 0.5*u
dispt output
"""
PENDULUM = """g = 9.81 | l = 0.7 | c = 0.4 | T = 0 | a = 0.3 | w = 0 | TMAX = 60 | DT = 0.01 | NN = 601
drun
DYNAMIC
d/dt a = w
d/dt w = -g/l*sin(a) - c*w + T
dispt a
"""


def test_the_servo_against_control():
    """At rest the torque is g2*V: x'' = -2*200 (x - u) - (2*26 + 0.6) x'."""
    import control

    found = desire_tui.linearise(SERVO, "u -> x, output, torque")
    assert found["A"] == pytest.approx(np.array([[0.0, 1.0], [-400.0, -52.6]]))
    assert found["B"] == pytest.approx(np.array([[0.0], [400.0]]), rel=1e-9)
    assert found["C"] == pytest.approx(np.array([[1.0, 0.0], [2.0, 0.0], [-400.0, -52.0]]), rel=1e-8)
    assert found["D"] == pytest.approx(np.array([[0.0], [0.5], [400.0]]), rel=1e-8)
    magnitude = found.charts[0].series[0]
    wanted = control.tf([400.0], [1.0, 52.6, 400.0])
    answer = np.abs(wanted(1j * magnitude.x))
    assert magnitude.y == pytest.approx(20 * np.log10(answer), abs=1e-6)
    step = found.charts[3].series[0]
    assert step.y == pytest.approx(control.step_response(wanted, step.x).outputs, abs=1e-6)


def test_poles_of_a_pendulum_hanging_and_standing(subject):
    linearise = BY_NAME["linearise"].run
    hanging = linearise(subject(PENDULUM), "T -> a at steady", unwatched)
    frequency = np.sqrt(9.81 / 0.7)
    assert hanging.tables[0].columns["frequency"] == pytest.approx([frequency] * 2)
    assert hanging.tables[0].columns["damping"] == pytest.approx([0.2 / frequency] * 2)
    assert "stable: all poles on the left" in hanging.notes[0]
    standing = linearise(subject(PENDULUM, here={"a": np.pi, "w": 0.0}), "from here", unwatched)
    poles = -0.2 + np.array([1, -1]) * np.sqrt(0.04 + 9.81 / 0.7)
    assert sorted(standing["poles"].real) == pytest.approx(sorted(poles))
    assert "unstable: 1 of 2 poles" in standing.notes[0]


def test_margins_of_an_open_loop():
    """1/(s + 1)^3 has a gain margin of 8 (18.06 dB) at sqrt(3)."""
    text = """u = 0 | a = 0 | b = 0 | y = 0 | k = 4 | TMAX = 1 | DT = 0.01 | NN = 11
drun
DYNAMIC
d/dt a = k*u - a
d/dt b = a - b
d/dt y = b - y
"""
    margins = desire_tui.linearise(text, "u -> y").tables[1].columns
    assert margins["gain margin, dB"] == pytest.approx([20 * np.log10(2.0)], abs=1e-6)
    assert margins["at"] == pytest.approx([np.sqrt(3)], abs=1e-6)
    assert margins["zeros"] == ["none"]


def test_a_place_that_is_no_equilibrium_is_said():
    found = desire_tui.linearise(PENDULUM, "at start")
    assert found["x"] == pytest.approx([0.3, 0.0])
    assert any("no equilibrium: d/dt w = -4.1" in note for note in found.notes)
    assert found["A"][1, 0] == pytest.approx(-9.81 / 0.7 * np.cos(0.3))


def test_poles_along_a_run():
    found = desire_tui.linearise(PENDULUM, "along 7")
    assert len(found["t"]) == 7
    assert found["poles"].shape == (7, 2)
    assert found["poles"].real == pytest.approx(-0.2 * np.ones((7, 2)))


@pytest.mark.parametrize(
    ("request_", "message"),
    [
        ("T -> ", "the request ends where a quantity's name is expected"),
        ("a -> w", "'a' is no parameter, which an input has to be"),
        ("T -> q", "'q' is to be recorded, but the program does not have it"),
        ("at t = 100", "t = 100 is outside the run, 0 to 60"),
        ("from here", "there is no 'here' without a desktop"),
        ("along 1", "1 is no whole number from 2 on"),
    ],
)
def test_mistakes(request_, message):
    with pytest.raises(DesireError) as error:
        desire_tui.linearise(PENDULUM, request_)
    assert error.value.diagnostics[0].message == message


def test_a_time_between_samples_is_gone_to(subject):
    """The free pendulum without damping: its energy at t = 0.37 is that at the start, to the rule's error."""
    text = PENDULUM.replace("c = 0.4", "c = 0").replace("NN = 601", "NN = 7")
    found = BY_NAME["linearise"].run(subject(text), "at t = 0.37", unwatched)
    a, w = found["x"]
    assert found["t"] == pytest.approx(0.37, abs=0.01)
    assert 0.5 * w * w - 9.81 / 0.7 * np.cos(a) == pytest.approx(-9.81 / 0.7 * np.cos(0.3), abs=1e-4)


def test_here_needs_the_programs_own_states(subject):
    linearise = BY_NAME["linearise"].run
    with pytest.raises(DesireError, match="w has no value now"):
        linearise(subject(PENDULUM, here={"a": 0.1, "t": 2.0}), "from here", unwatched)
    assert (
        linearise(subject(PENDULUM, here={"a": 0.1, "w": 0.0, "t": 2.0}), "from here", unwatched)["t"] == 2.0
    )
