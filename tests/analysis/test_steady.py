"""Steady states of models whose steady states are known."""

from __future__ import annotations

import numpy as np
import pytest

from desire_tui.analysis.equilibria.kinds import kind
from desire_tui.analysis.progress import unwatched
from desire_tui.analysis.steady.steady import analyse
from desire_tui.engine.diagnostics import DesireError

LORENZ = """s = 10 | r = 28 | b = 8/3 | x = 1 | y = 1 | z = 20 | TMAX = 2 | DT = 0.01 | NN = 101
drun
DYNAMIC
d/dt x = s*(y - x)
d/dt y = x*(r - z) - y
d/dt z = x*y - b*z
dispxy x, z
"""
CHAIN = """k1 = 2 | k2 = 1 | k3 = 0.5 | a = 1 | b = 0 | c = 0.5 | e = 3 | TMAX = 20 | DT = 0.01 | NN = 101
drun
DYNAMIC
d/dt a = -k1*a + k2*b
d/dt b = k1*a - k2*b - k3*b + k3*c
d/dt c = k3*b - k3*c
d/dt e = 2*(k1*a - k2*b)
dispt a, b, c
"""


def scalar(rate, start="0.5"):
    return f"c = 1 | x = {start} | TMAX = 1 | DT = 0.01 | NN = 11\ndrun\nDYNAMIC\nd/dt x = {rate}\ndispt x\n"


def told(subject, text, request="", **settings):
    with pytest.raises(DesireError) as error:
        analyse(subject(text, **settings), request, unwatched)
    (problem,) = error.value.diagnostics
    return problem.message


def test_lorenz_has_three_with_known_eigenvalues(subject):
    found = analyse(subject(LORENZ), "", unwatched)
    order = np.argsort(found["states"]["x"])
    root = np.sqrt(8 / 3 * 27)
    assert found["states"]["x"][order] == pytest.approx([-root, 0, root], abs=1e-12)
    assert found["states"]["z"][order] == pytest.approx([27, 0, 27], abs=1e-12)
    assert [found["kinds"][k] for k in order] == ["saddle focus", "saddle", "saddle focus"]
    # λ^3 + (s + b + 1) λ^2 + b (r + s) λ + 2 b s (r - 1) = 0 at the outer ones
    expected = np.roots([1, 41 / 3, 8 / 3 * 38, 20 * 8 / 3 * 27])
    assert np.sort_complex(found["eigenvalues"][order[0]]) == pytest.approx(np.sort_complex(expected))
    middle = [-8 / 3, *np.roots([1, 11, -270])]
    assert np.sort(found["eigenvalues"][order[1]].real) == pytest.approx(np.sort(middle))


def test_settings_hold_and_here_is_where_it_begins(subject):
    model = subject(LORENZ, settings={"r": 5.0}, here={"x": -3.0, "y": -3.0, "z": 4.0})
    found = analyse(model, "from here", unwatched)
    assert found["states"]["z"] == pytest.approx([4.0])
    assert found["states"]["x"] == pytest.approx([-np.sqrt(8 / 3 * 4)])
    assert found["kinds"] == ["stable focus"]


def test_a_box_holds_what_is_told(subject):
    found = analyse(subject(scalar("sin(x)")), "all in x = [-7, 5]", unwatched)
    order = np.argsort(found["states"]["x"])
    assert found["states"]["x"][order] == pytest.approx(np.pi * np.arange(-2, 2), abs=1e-12)
    assert [found["kinds"][k] for k in order] == [
        "unstable node",
        "stable node",
        "unstable node",
        "stable node",
    ]


def test_conserved_sums_are_found_and_held(subject):
    found = analyse(subject(CHAIN), "", unwatched)
    # a + b + c = 1.5 and 2 a + e = 5 hold; k1 a = k2 b, b = c
    assert {name: float(x[0]) for name, x in found["states"].items()} == pytest.approx(
        {"a": 0.3, "b": 0.6, "c": 0.6, "e": 4.4}
    )
    laws = np.array([list(law.values()) for law in found["conserved"]])
    assert laws.shape == (2, 4)
    for law in [(1, 1, 1, 0), (2, 0, 0, 1)]:
        assert np.linalg.matrix_rank(np.vstack([laws, law]), tol=1e-9) == 2
    assert any("conserved: " in note and "= " in note for note in found.notes)
    # λ^2 + (k1 + k2 + 2 k3) λ + k1 k2 ... of the two free states
    matrix = np.array([[-2.0, 1.0, 0.0], [2.0, -1.5, 0.5], [0.0, 0.5, -0.5]])
    expected = np.sort(np.linalg.eigvals(matrix).real)[:2]
    assert np.sort(found["eigenvalues"][0].real) == pytest.approx(expected)


def test_a_curve_of_steady_states_is_said_to_be_one(subject):
    sir = """b = 0.5 | g = 0.2 | s = 1 | i = 0.01 | TMAX = 100 | DT = 0.05 | NN = 101
drun
DYNAMIC
d/dt s = -b*s*i
d/dt i = b*s*i - g*i
dispt s, i
"""
    found = analyse(subject(sir), "", unwatched)
    assert found["kinds"] == ["degenerate", "degenerate"]
    assert any("a curve of steady states" in note for note in found.notes)


@pytest.mark.parametrize(
    ("rate", "start", "words"),
    [
        ("exp(-x)", "1", "66 run off to infinity"),
        ("c", "1", "66 end where the Jacobian is singular"),
        ("x*x + 1", "0.5", "no steady state is found: of 66 starts"),
        ("sin(2*t) - x", "0.5", "the derivative of x depends on t"),
        ("-delay(x, 0.1)", "1", "the derivatives are no function of t and the states alone"),
    ],
)
def test_what_has_none_says_why(subject, rate, start, words):
    assert words in told(subject, scalar(rate, start))


def test_a_degenerate_one_and_a_run_that_fails(subject):
    found = analyse(subject(scalar("x*x")), "", unwatched)
    assert found["kinds"] == ["degenerate"]
    assert found["states"]["x"] == pytest.approx([0], abs=1e-6)
    found = analyse(subject(scalar("x^3 - x", "5")), "", unwatched)
    assert np.sort(found["states"]["x"]) == pytest.approx([-1, 0, 1], abs=1e-12)
    assert any("the run ended early" in note for note in found.notes)


@pytest.mark.parametrize(
    ("request_", "words"),
    [
        ("all in q = [0, 1]", "'q' is no state"),
        ("all in x = [1, 0]", "the interval from 1 to 0 holds nothing"),
        ("from there", "'there' stands where 'here' is expected"),
        ("k", "'k' stands at the end, where nothing is expected"),
    ],
)
def test_requests_that_are_wrong(subject, request_, words):
    assert words in told(subject, scalar("-x"), request_)


def test_events_are_said_to_be_left_out(subject):
    text = "x = 1 | TMAX = 2 | DT = 0.01 | NN = 11\ndrun\nDYNAMIC\nd/dt x = 1 - x\ndispt x\nevent x - 0.5\nx = 2\n"
    found = analyse(subject(text), "", unwatched)
    assert found.notes[0].startswith("events are left out")
    assert not analyse(subject(scalar("-x")), "", unwatched).notes[0].startswith("events")


def test_it_can_be_stopped(subject):
    found = analyse(subject(scalar("sin(x)")), "all in x = [-90, 90]", lambda part, *_: not part)
    assert found.is_partial


@pytest.mark.parametrize(
    ("values", "name"),
    [
        ([-1, -2], "stable node"), ([1, 2], "unstable node"), ([-1 + 2j, -1 - 2j], "stable focus"),
        ([1 + 2j, 1 - 2j], "unstable focus"), ([1, -1], "saddle"), ([2j, -2j], "centre"),
        ([-1, 1 + 1j, 1 - 1j], "saddle focus"), ([0, -1], "degenerate"), ([2j, -2j, -1], "centre, the rest stable"),
        ([-0.1, -3 + 1j, -3 - 1j], "stable node"), ([-3, -0.1 + 1j, -0.1 - 1j], "stable focus"),
    ],
)  # fmt: skip
def test_kinds(values, name):
    assert kind(np.sort_complex(np.array(values, dtype=complex))[::-1]) == name


def test_over_a_parameter_a_table_has_all(subject):
    found = analyse(subject(scalar("c*x - x*x*x")), "over c in [-1, 1] places 5", unwatched)
    c, x, stable = found["c"], found["states"]["x"], found["stable"]
    assert c == pytest.approx([-1, -0.5, 0, 0.5, 0.5, 0.5, 1, 1, 1])
    root = np.sqrt(0.5)
    assert x == pytest.approx([0, 0, 0, -root, 0, root, -1, 0, 1], abs=1e-6)
    assert stable[:2].all()
    assert stable[3:].tolist() == [True, False, True] * 2
    assert found.tables[0].columns["c"] == c.tolist()
    assert [one.name for one in found.charts[0].series] == ["stable", "unstable"]


def test_values_without_steady_states_are_told(subject):
    found = analyse(subject(scalar("c - x*x")), "from here over c in [-1, 2] places 4", unwatched)
    assert found["states"]["x"][found["c"] > 0] == pytest.approx(np.sqrt([1, 2]))
    assert any("of 4 values there is none" in note for note in found.notes)
    assert told(subject, scalar("1 + x*x*c"), "from here over c in [1, 2] places 2") == (
        "no steady state is found for c from 1 to 2"
    )
    assert "has no influence" in told(subject, scalar("1 - x + 0*c"), "over c in [1, 2]")
    assert "holds nothing" in told(subject, scalar("c - x"), "over c in [2, 1]")


def test_over_a_parameter_it_can_be_stopped(subject):
    parts = []

    def once(part, what, so_far=None):
        parts.append(part)
        return len(parts) < 9

    found = analyse(subject(scalar("c - x")), "from here over c in [1, 2]", once)
    assert found.is_partial
    assert 0 < len(found["c"]) < 21
