"""`Model.rhs` and `Model.jacobian`: what other people's solvers get, from Python and as C functions."""

from __future__ import annotations

import ctypes
import re

import numpy as np
import pytest

import desire_tui
from desire_tui import DesireError

LOTKA = """a = 1 | b = 2*a | x = 3 | y = 0.5 | TMAX = 1 | DT = 0.01
drun
DYNAMIC
both = x*y
d/dt x = a*x - b*both
d/dt y = both - y + sin(t)
dispt x
"""
HEAT = """n = 5
STATE u[n]
u[3] = 1 | TMAX = 1 | DT = 0.01
drun
DYNAMIC
u[1] = 25
Vectr d/dt u = u{1} - 2*u + u{-1}
"""


@pytest.fixture(scope="module", params=["native", "reference"])
def lotka(request):
    return desire_tui.load(LOTKA, backend=request.param)


def expected(t, x, a=1.0):
    return [a * x[0] - 2 * a * x[0] * x[1], x[0] * x[1] - x[1] + np.sin(t)]


def test_derivatives_at_one_place_and_at_many(lotka):
    assert lotka.rhs.states == ("x", "y")
    assert lotka.rhs.start == pytest.approx([3, 0.5])
    assert lotka.rhs(2, [3, 0.5]) == pytest.approx(expected(2, [3, 0.5]))
    places = np.array([[3, 1, 2], [0.5, 4, 6]])
    found = lotka.rhs(2.0, places)
    assert found.shape == (2, 3)
    assert found == pytest.approx(np.array([expected(2, x) for x in places.T]).T)
    found = lotka.rhs([1, 2, 3], places)
    assert found == pytest.approx(
        np.array([expected(t, x) for t, x in zip((1, 2, 3), places.T, strict=True)]).T
    )
    assert lotka.rhs(0, np.zeros((2, 0))).shape == (2, 0)


def test_jacobians_at_many_places(lotka):
    places = np.array([[3, 1, 2], [0.5, 4, 6]])
    found = lotka.jacobian(0.0, places)
    assert found.shape == (3, 2, 2)
    for k in range(3):
        assert np.array_equal(found[k], lotka.jacobian(0.0, places[:, k]))
    assert lotka.jacobian(0, np.zeros((2, 0))).shape == (0, 2, 2)
    with pytest.raises(ValueError, match="x has shape"):
        lotka.jacobian(0.0, places.T)


def test_parameters_for_which_the_script_runs_anew_hold_at_once():
    text = "ARRAY k[2]\nk[1] = 1 | k[2] = 5 | x = 1 | TMAX = 1 | DT = 0.1\ndrun\nDYNAMIC\nd/dt x = -k[1]*x\ndispt x\n"
    rhs = desire_tui.load(text).rhs
    for value in (1.0, 2.0, 1.0, 3.0):
        assert rhs(0.0, [1.0], **{"k[1]": value}) == [-value]


def test_the_jacobian_is_exact(lotka):
    assert lotka.jacobian(0, [3, 0.5]) == pytest.approx(np.array([[0, -6], [0.5, 2]]), rel=1e-15, abs=1e-15)
    assert lotka.jacobian.sparse(0, [3, 0.5]).toarray() == pytest.approx(lotka.jacobian(0, [3, 0.5]))


def test_parameters_and_what_follows_from_them(lotka):
    assert lotka.rhs(2, [3, 0.5], a=5) == pytest.approx(expected(2, [3, 0.5], 5))
    assert lotka.rhs(2, [3, 0.5]) == pytest.approx(expected(2, [3, 0.5]))
    assert lotka.jacobian(0, [3, 0.5], a=5)[0, 1] == pytest.approx(-30)
    rhs, jacobian = lotka.equations(a=5)
    assert rhs(2, [3, 0.5]) == pytest.approx(expected(2, [3, 0.5], 5))
    assert rhs(2, [3, 0.5], b=0)[0] == pytest.approx(15)
    assert jacobian(0, [3, 0.5])[0, 1] == pytest.approx(-30)
    with pytest.raises(TypeError, match=r"no parameter or setting 'aa'"):
        lotka.rhs(0, [1, 1], aa=1)


def test_runs_of_the_model_and_its_functions_do_not_disturb_each_other(lotka):
    before = lotka.rhs(2, [3, 0.5])
    lotka.run(a=9, initial=[1, 1])
    assert np.array_equal(lotka.rhs(2, [3, 0.5]), before)
    lotka.rhs(7, [1e9, 1e9], b=1e9)
    assert lotka.run().initial == {"x": 3.0, "y": 0.5}


def test_c_functions_do_the_same():
    model = desire_tui.load(LOTKA)
    rhs, jacobian = model.equations(a=5)
    x, out = (ctypes.c_double * 2)(3, 0.5), (ctypes.c_double * 4)()
    assert rhs.ctypes(2.0, x, out, None) == 0
    assert list(out)[:2] == pytest.approx(expected(2, [3, 0.5], 5))
    kind = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_double, *[ctypes.c_void_p] * 3)
    assert kind(jacobian.address)(0.0, ctypes.addressof(x), ctypes.addressof(out), 0) == 0
    assert list(out) == pytest.approx([0, -30, 0.5, 2])
    assert rhs.ctypes(2.0, (ctypes.c_double * 2)(1e308, 1e308), out, None) == 1
    with pytest.raises(RuntimeError, match="no machine code"):
        _ = desire_tui.load(LOTKA, backend="reference").rhs.address


def test_a_low_level_callable_knows_the_signature():
    from scipy import LowLevelCallable

    function = LowLevelCallable(desire_tui.load(LOTKA).rhs.ctypes)
    assert function.signature == "int (double, double *, double *, void *)"


def test_scipy_integrates_a_stiff_model_to_its_tolerance():
    from scipy.integrate import solve_ivp

    # linear, eigenvalues -1 and -1000: x = 2 exp(-t) - exp(-1000 t), y = -exp(-t) + exp(-1000 t)
    model = desire_tui.load(
        "x = 1 | TMAX = 1 | DT = 0.001\ndrun\nDYNAMIC\nd/dt x = 998*x + 1998*y\nd/dt y = -999*x - 1999*y\n"
    )
    found = solve_ivp(
        model.rhs, (0, 2), model.rhs.start, "BDF", jac=model.jacobian, rtol=1e-8, atol=1e-10, vectorized=True
    )
    assert found.y[:, -1] == pytest.approx([2 * np.exp(-2), -np.exp(-2)], rel=1e-6)
    assert found.njev <= 5


@pytest.mark.parametrize("backend", ["native", "reference"])
def test_vectors_and_a_state_that_every_pass_assigns(backend):
    model = desire_tui.load(HEAT, backend=backend)
    u = np.array([0, 1, 2, 3, 4.0])
    assert model.rhs(0, u) == pytest.approx([0, 25 - 2 + 2, 0, 0, 3 - 8])
    rows = [[0, 0, 0, 0, 0], [0, -2, 1, 0, 0], [0, 1, -2, 1, 0], [0, 0, 1, -2, 1], [0, 0, 0, 1, -2]]
    assert model.jacobian(0, u) == pytest.approx(np.array(rows))
    assert model.jacobian.sparse(0, u).toarray() == pytest.approx(np.array(rows))
    assert (model.jacobian.sparsity.toarray() >= np.abs(np.sign(rows))).all()
    assert model.jacobian.sparsity.nnz <= 15
    assert model.equations(n=3)[0](0, u[:3]) == pytest.approx([0, 25 - 2 + 2, 1 - 4])


def test_what_cannot_be_differentiated_is_taken_from_the_program_or_differenced():
    text = "ARRAY F[4], J[1,1]\nF[1] = 1 | F[2] = 2 | x = 2 | TMAX = 1 | DT = 0.1\ndrun\nDYNAMIC\nF[4] = x*x\nd/dt x = -func1(1.5; F)\n"
    for backend in ("native", "reference"):
        model = desire_tui.load(text, backend=backend)
        assert model.rhs(0, [3]) == pytest.approx([-4.5])  # halfway between 0 and 9
        assert model.jacobian(0, [3]) == pytest.approx(np.array([[-3]]), rel=1e-6)
    own = desire_tui.load(f"{text}JACOBIAN\nJ[1,1] = -7\n")
    assert own.jacobian(0, [3]) == pytest.approx(np.array([[-7]]))


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("d/dt x = ran()", "a random number"),
        ("d/dt x = -delay(x, 0.5)", "a delay"),
        ("if t - 1\ny = t\nproceed\nd/dt x = y", "what was there before"),
        ("y = 0.5*y + t\nd/dt x = y", "what was there before"),
        ("y = t", "has no d/dt"),
    ],
)
def test_derivatives_that_are_no_function_of_t_and_the_states(line, words):
    model = desire_tui.load(f"x = 1 | y = 0 | TMAX = 1 | DT = 0.1 | NN = 3\ndrun\nDYNAMIC\n{line}\n")
    with pytest.raises(DesireError, match=re.escape(words)):
        _ = model.rhs


def test_wrong_shapes(lotka):
    for wrong in ([1], [[1, 2]], np.zeros((2, 2, 2))):
        with pytest.raises(ValueError, match="has 2 states"):
            lotka.rhs(0, wrong)
    with pytest.raises(ValueError, match="has 2 states"):
        lotka.jacobian(0, [1, 2, 3])
