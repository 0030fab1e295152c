"""Boundary values that a segment assigns to states (`u[n] = 25`) under the multistep rules: right, and no dearer."""

import functools

import numpy as np
import pytest

from tests.reference.runs import array, run

NEWTON = (10, 11, 14, 15)
SHORT_STEPS = (9, 12, 13, 16)
"""Functional iteration and the diagonal alone converge at short steps only: 1.2 million a unit of time for 501 points."""
HEAT = """irule {rule} | ERMAX = 1e-4 | n = {n} | m = n - 2
left = 1 | right = 2 | c = (n - 1)^2
{declare}
for i = 1 to m | {u}[i + {skip}] = 1 + i/(n - 1) + sin(PI*i/(n - 1)) | next
TMAX = {tmax} | NN = 5
drun
DYNAMIC
{body}
dispt {u}[2]
"""
ASSIGNED = {
    "before": "u[1] = left\nu[n] = right\nVectr d/dt u = c*(u{{-1}} - 2*u + u{{1}})",
    "behind": "Vectr d/dt u = c*(u{{-1}} - 2*u + u{{1}})\nu[1] = left | u[n] = right",
}


def heat(rule, n, tmax, backend, how):
    parts = {"declare": "STATE u[n]", "u": "u", "skip": 1, "body": ASSIGNED[how].format()}
    return run(HEAT.format(rule=rule, n=n, tmax=tmax, **parts), backend=backend)


@functools.cache
def with_parameters(rule, n, tmax, backend):
    """Return the finished run of the same rod whose ends are parameters."""
    parts = {
        "declare": "STATE w[m] | ARRAY b[m] | b[1] = c*left | b[m] = c*right",
        "u": "w",
        "skip": 0,
        "body": "Vectr d/dt w = c*(w{-1} - 2*w + w{1}) + b",
    }
    return run(HEAT.format(rule=rule, n=n, tmax=tmax, **parts), backend=backend).runs[0]


def exact(n, t):
    """The solution of the equations, differences in space and all: its wave is one of their eigenvectors."""
    x = np.linspace(0, 1, n)
    rate = -4 * (n - 1) ** 2 * np.sin(np.pi / (2 * (n - 1))) ** 2
    return 1 + x + np.sin(np.pi * x) * np.exp(rate * t)


@pytest.mark.parametrize("how", ASSIGNED)  # one after the other: their rod of comparison is the same
@pytest.mark.parametrize(
    ("rule", "n", "tmax", "backend"),
    [
        *((rule, 51, 0.1, "native") for rule in range(9, 17)),
        *((rule, 501, 0.1, "native") for rule in NEWTON),
        *((rule, 501, 0.01, "native") for rule in SHORT_STEPS),
        *((rule, 51, 0.02, "reference") for rule in (10, 12, 14, 15, 16)),
    ],
)
def test_fixed_ends_of_a_rod(rule, n, tmax, backend, how):
    session, wanted = heat(rule, n, tmax, backend, how), with_parameters(rule, n, tmax, backend)
    np.testing.assert_allclose(array(session, "u"), exact(n, tmax), rtol=0, atol=10 * 1e-4 * 2)
    assert session.runs[0].steps <= 1.5 * wanted.steps
    assert rule not in NEWTON or session.runs[0].steps < 100
    assert session.runs[0].rejected <= 1.5 * wanted.rejected + 5


MOVING = """irule {rule} | ERMAX = 1e-5 | n = {n}
STATE u[n] | ARRAY x[n]
for i = 1 to n | x[i] = 25*(i - 1)/(n - 1) | next
TMAX = 3 | NN = 31 | c = (n - 1)^2/100
drun
DYNAMIC
{body}
dispt u[2], u[n]
"""
ENDS = "u[1] = 0\nu[n] = 25*sin(t)\n"


@pytest.mark.parametrize("backend", ["native", "reference"])
@pytest.mark.parametrize("body", [ENDS + "{0}", "{0}\n" + ENDS, "b = 25*sin(t)\nu[1] = 0 | u[n] = b\n{0}"])
@pytest.mark.parametrize("rule", range(9, 17))
def test_a_moving_end(rule, body, backend):
    """u = x·sin t solves the equations with this source; the end is seen at every t at which they are."""
    text = body.format("Vectr d/dt u = c*(u{-1} - 2*u + u{1}) + x*cos(t)")
    session = run(MOVING.format(rule=rule, n=21, body=text), backend=backend)
    wanted = 25 * np.linspace(0, 1, 21) * np.sin(3)
    np.testing.assert_allclose(array(session, "u"), wanted, rtol=0, atol=10 * 1e-5 * 25)
    record = session.runs[0]
    times = np.linspace(0, 3, 31)
    np.testing.assert_allclose(record.rows[: record.count, 2], 25 * np.sin(times), rtol=0, atol=1e-12)
    np.testing.assert_allclose(
        record.rows[: record.count, 1], 1.25 * np.sin(times), rtol=0, atol=10 * 1e-5 * 25
    )
    assert record.steps < 3000


@pytest.mark.parametrize("backend", ["native", "reference"])
@pytest.mark.parametrize("rule", [14, 15])
def test_a_jacobian_of_ones_own(rule, backend):
    """Lines for the assigned state are not used: it has no equation."""
    text = """irule {rule} | ERMAX = 1e-6 | STATE y[3] | ARRAY J[3,3] | k = 1000
y[1] = 1 | TMAX = 1 | NN = 3
drun
DYNAMIC
y[2] = 2 + t
d/dt y[1] = -k*(y[1] - y[2])
d/dt y[2] = -y[2]
d/dt y[3] = y[1] - y[3]
dispt y[3]
JACOBIAN
J[1,1] = -k | J[1,2] = k | J[2,2] = -1 | J[3,1] = 1 | J[3,3] = -1
"""
    session = run(text.format(rule=rule), backend=backend)
    lag = 1 / 1000
    y1 = 2 + 1 - lag  # and a transient that is over
    assert array(session, "y")[0] == pytest.approx(y1, abs=1e-4)
    steps = session.runs[0].steps
    assert array(session, "y")[2] == pytest.approx(y3(lag), abs=1e-4)
    assert steps < 200


def y3(lag):
    """y[3] at t = 1 of y' = y1 - y, y1 = 2 + t - lag + (lag - 1)·exp(-t/lag)."""
    share = (lag - 1) / (1 - 1 / lag)
    return (1 - lag) + 1 - (1 - lag) * np.exp(-1) + share * (np.exp(-1 / lag) - np.exp(-1))


@pytest.mark.parametrize("backend", ["native", "reference"])
@pytest.mark.parametrize("rule", [10, 15])
def test_a_state_that_is_moved_stays_one(rule, backend):
    """A difference equation or a jump changes a state; both are what they were."""
    text = "irule {rule} | ERMAX = 1e-6 | x = 1 | y = 1 | TMAX = 1 | NN = 5\ndrun\nDYNAMIC\nd/dt x = -x\nd/dt y = -y\nOUT\ny = 2*y"
    session = run(text.format(rule=rule), backend=backend)
    assert session.values.cells[session.values.names["x"].slot] == pytest.approx(np.exp(-1), abs=1e-5)
    assert session.values.cells[session.values.names["y"].slot] == pytest.approx(32 * np.exp(-1), abs=1e-3)
