"""Derived Jacobians and patterns against central differences of the model itself."""

from __future__ import annotations

import numpy as np
import pytest

from desire_tui.engine.passes.differentiate import differentiate
from desire_tui.engine.passes.slices import derivative_slice
from desire_tui.engine.passes.sparsity import sparsity_pattern
from desire_tui.engine.passes.tangents import NotDifferentiable
from desire_tui.engine.reference.backend import ReferenceBackend
from desire_tui.engine.reference.statements import StatementClosures
from desire_tui.engine.values import T
from tests.integration.stiff_programs import run


def lowered(text):
    """The segment of a program that has run, its values, its state slots."""
    caught = []

    def model(backend, segment, rule, values, **how):
        caught.append(segment)
        return real(backend, segment, rule, values, **how)

    real = ReferenceBackend.model
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ReferenceBackend, "model", model)
        session, _ = run(text, "reference")
    segment = caught[-1]
    slots = np.concatenate([np.arange(s.slot, s.slot + s.count) for s in segment.states])
    return segment, session.values, slots


class Model:
    def __init__(self, text):
        self.segment, self.values, self.slots = lowered(text)
        self.n = len(self.slots)
        self._plain = StatementClosures(self.values, self.n)
        self._pass = self._plain.compile(derivative_slice(self.segment))

    def f(self, x):
        self.values.data[self.slots] = x
        self._pass()
        return self._plain.derivatives.copy()

    def exact(self, x):
        tangent = differentiate(self.segment, self.values.room)
        statements = StatementClosures(self.values, self.n)
        body = statements.compile(tangent.body)
        columns = []
        for state in range(self.n):
            self.values.data[self.slots] = x
            self.values.data[tangent.directions + state] = 1.0
            body()
            self.values.data[tangent.directions + state] = 0.0
            columns.append(statements.derivatives.copy())
        return np.array(columns).T

    def differenced(self, x, h=1e-6):
        columns = []
        for state in range(self.n):
            step = np.zeros(self.n)
            step[state] = h
            columns.append((self.f(x + step) - self.f(x - step)) / (2 * h))
        return np.array(columns).T


def program(script, body):
    return f"{script}\nDT = 0.01 | TMAX = 0.01 | NN = 2\ndrun\nDYNAMIC\n{body}\n"


def compare(text, *, tolerance=1e-7, seed=1, scale=1.0):
    model = Model(text)
    rows, columns = sparsity_pattern(model.segment)
    pattern = np.zeros((model.n, model.n), dtype=bool)
    pattern[rows, columns] = True
    generator = np.random.default_rng(seed)
    for _ in range(3):
        x = scale * generator.uniform(0.2, 0.9, model.n)
        exact, differenced = model.exact(x), model.differenced(x)
        assert exact == pytest.approx(differenced, abs=tolerance * max(1.0, np.abs(differenced).max()))
        assert not (exact[~pattern] != 0).any()
    return pattern


SCALAR = [
    "x*y + y/x - 3*x",
    "x^3 + y^-2 + x^0 + y^1",
    "x^y + (x + 1)^1.5",
    "sin(x)*cos(y) + tan(x*y)",
    "asin(x) + acos(y) + atan(x/y) + atan2(x, y)",
    "sinh(x) - cosh(y) + tanh(x - y)",
    "exp(-x*y) + ln(x) + log(y) + sqrt(x*y)",
    "abs(x - y) + lim(x - y) + lim(y - 2)",
    "sat(2*x) + SAT(x + y - 0.5) + deadz(3*x) + deadc(5*y)*x",
    "swtch(x - y)*x + sgn(y - x)*y + comp(x - y, x^2, y^2)",
    "rect(x)*y + tri(x - y) + sinc(x + y)",
    "sigmoid(x*y) + SIGMOID(x) + SIGMOID(-y) + round(x)*y + trnc(3*y)*x",
    "max(x, y) + min(x, y)*2",
    "-x - (-y)*x + t*x",
]


@pytest.mark.parametrize("expression", SCALAR)
def test_each_library_function(expression):
    compare(program("x = 0.5 | y = 0.4", f"d/dt x = {expression}\nd/dt y = x - y"))


def test_through_defined_variables_and_functions():
    text = program(
        "FUNCTION hyp(a$, b$) = sqrt(a$^2 + b$^2)\nx = 0.5 | y = 0.4 | k = 3",
        "p = k*x*y\nq = hyp(p, y) + p\nr = sin(k)\nd/dt y = q - x\nd/dt x = p*q + r*x",
    )
    assert compare(text).all()


def test_a_table_function():
    script = "ARRAY X[5] + Y[5] = F\nfor i = 1 to 5 | X[i] = i/5 | Y[i] = i^2 | next\nx = 0.5"
    compare(program(script, "d/dt x = func1(x; F)*x\nd/dt y = x*y"), tolerance=1e-6, seed=4)


def test_elementwise_vectors_give_a_diagonal():
    text = program("n = 6 | STATE x[n]\nARRAY a[n], y[n]\nfor i = 1 to n | a[i] = i | x[i] = 0.5 | next",
                   "Vector y = a*sin(x)\nVectr d/dt x = y*x - exp(a*0.1)")  # fmt: skip
    assert (compare(text) == np.eye(6, dtype=bool)).all()


def test_shifts_give_bands():
    text = program("n = 8 | STATE u[n]", "Vectr d/dt u = 3*(u{1} - 2*u + u{-1}) - u*u{2}")
    pattern = compare(text)
    i, k = np.indices((8, 8))
    assert (pattern == ((k - i >= -1) & (k - i <= 2))).all()


def test_shifted_defined_vectors():
    text = program(
        "n = 8 | STATE u[n] | ARRAY flux[n]", "Vector flux = u*u - u{-1}\nVectr d/dt u = flux{1} - flux"
    )
    pattern = compare(text)
    i, k = np.indices((8, 8))
    assert (pattern == (np.abs(k - i) <= 1)).all()


def test_products_with_matrices_give_blocks():
    text = program(
        "STATE x[3], z[2]\nARRAY A[3,3], B[2,3]\nSEED 3\n"
        "for i = 1 to 3 | for k = 1 to 3 | A[i,k] = ran() | next | next\n"
        "for i = 1 to 2 | for k = 1 to 3 | B[i,k] = ran() | next | next",
        "Vectr d/dt x = A*x - B%*z\nVectr d/dt z = tanh(B*x) - z",
    )
    pattern = compare(text)
    assert pattern[:3].all()
    assert (pattern[3:, 3:] == np.eye(2, dtype=bool)).all()


def test_dot_products_reach_everywhere():
    text = program("STATE x[4]\nARRAY w[4]\nfor i = 1 to 4 | w[i] = i | next",
                   "DOT s = x*x + w*x\nAVG m = x*1\nVectr d/dt x = -x*s + m\nd/dt y = s*y")  # fmt: skip
    pattern = compare(text)
    assert pattern[:4, :4].all()
    assert not pattern[:4, 4].any()


def test_elements_of_arrays_and_vectors_mix():
    text = program("STATE x[3]", "d/dt x[1] = x[2]*x[3]\nd/dt x[2] = -x[1]\nd/dt x[3] = y\nd/dt y = x[1] - y")
    pattern = compare(text)
    assert pattern.tolist() == [
        [False, True, True, False],
        [True, False, False, False],
        [False, False, False, True],
        [True, False, False, True],
    ]


def test_an_overlay_of_two_state_vectors():
    text = program("STATE a[3] + b[3] = ab", "Vectr d/dt a = b\nVectr d/dt b = -a*b\nDOT s = ab*ab")
    compare(text)


@pytest.mark.parametrize(
    ("script", "body"),
    [
        ("x = 1 | y = 0", "y = y + 0.5*deadz(x - y)\nd/dt x = -y"),
        ("x = 1", "d/dt x = -x + ran()"),
    ],
)  # fmt: skip
def test_what_remembers_or_draws_has_no_derivative(script, body):
    segment, values, _ = lowered(program(script, body))
    with pytest.raises(NotDifferentiable):
        differentiate(segment, values.room)


def test_nothing_but_the_states_moves():
    """The tangent pass leaves states and t alone, and its own numbers are 0 before and after."""
    model = Model(program("x = 0.5 | y = 0.4", "p = x*y\nd/dt x = p\nd/dt y = -p*x"))
    x = np.array([0.3, 0.7])
    model.values.data[T] = 1.25
    model.exact(x)
    assert model.values.data[model.slots].tolist() == x.tolist()
    assert model.values.cells[T] == 1.25


@pytest.mark.parametrize(
    ("script", "body"),
    [
        ("STATE x[3], z[3] | ARRAY y[3]", "Vector y = x\nVectr delta y = z\nVectr d/dt x = y\nVectr d/dt z = -x"),
        ("STATE x[2], z[2] | ARRAY W[2,2], y[2]",
         "MATRIX W = x*z\nDELTA W = z*z\nVector y = W*x\nVectr d/dt x = y\nVectr d/dt z = -z"),
        ("STATE x[2], z[2] | ARRAY W[2,2], M[2,2], y[2], one[2]\nM[1,2] = 1 | one[1] = 1 | one[2] = 1",
         "MATRIX W = x*z\nMATRIX W = [M] one*z\nVector y = W*one\nVectr d/dt x = y\nVectr d/dt z = -z"),
        ("x = 0.5 | z = 0.4 | h = 0.1 | k = 0.2", "trkhld h, k = z, x*z\nd/dt x = k\nd/dt z = h - z"),
    ],
    ids=["delta", "DELTA", "mask", "trkhld"],
)  # fmt: skip
def test_what_a_statement_leaves_as_it_was_still_depends_on_what_it_depended_on(script, body):
    """Where derivatives have no exact tangent, differences fill the pattern: it must hold all they touch."""
    model = Model(program(script, body))
    rows, columns = sparsity_pattern(model.segment)
    pattern = np.zeros((model.n, model.n), dtype=bool)
    pattern[rows, columns] = True
    x = np.random.default_rng(2).uniform(0.2, 0.9, model.n)
    assert not (np.abs(model.differenced(x)[~pattern]) > 1e-6).any()
