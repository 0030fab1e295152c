"""Our BDF takes the same steps as CVODE; its linear algebra is right; what cannot be solved gets CVODE's flags."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass
from math import cos, exp

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from desire_tui.engine.codegen.compiler_state import shared_state
from desire_tui.engine.integration.bdf import memory, newton, step
from desire_tui.engine.integration.bdf.memory import Evaluate, Fill, Weigh
from desire_tui.engine.integration.bdf.solver import OwnSolver
from desire_tui.engine.integration.callbacks import numbers
from desire_tui.engine.integration.sundials import library
from desire_tui.engine.integration.sundials.linear import Linear
from desire_tui.engine.integration.sundials.signatures import JacobianFunction, RhsFunction, WeightFunction
from desire_tui.engine.integration.sundials.solver import Callbacks, Solver
from desire_tui.engine.session.listener import Listener
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source

TOLERANCE = 1e-6


@dataclass
class Problem:
    """y' = f(t, y) with its Jacobian; `big`: the states' largest values; `first`: step, 0 for none."""

    f: object
    jacobian: object
    start: tuple
    big: tuple
    t_end: float
    first: float


PROBLEMS = {
    "oscillator": Problem(
        lambda t, y: [y[1], -y[0] + np.sin(3 * t)], lambda _, __: [[0, 1], [-1, 0]], (1, 0), (1, 1), 20, 0
    ),
    "Robertson": Problem(
        lambda _, y: [1e4 * y[1] * y[2] - 0.04 * y[0],
                      0.04 * y[0] - 1e4 * y[1] * y[2] - 3e7 * y[1] ** 2, 3e7 * y[1] ** 2],
        lambda _, y: [[-0.04, 1e4 * y[2], 1e4 * y[1]],
                      [0.04, -1e4 * y[2] - 6e7 * y[1], -1e4 * y[1]], [0, 6e7 * y[1], 0]],
        (1, 0, 0), (1, 4e-5, 1), 1e5, 1e-6,
    ),
    "Van der Pol": Problem(
        lambda _, y: [y[1], 1000 * (1 - y[0] ** 2) * y[1] - y[0]],
        lambda _, y: [[0, 1], [-2000 * y[0] * y[1] - 1, 1000 * (1 - y[0] ** 2)]],
        (2, 0), (2, 1300), 810, 1e-6,
    ),
    "forced decay": Problem(
        lambda t, y: [-2 * y[0] + cos(5 * t)], lambda _, __: [[-2]], (1,), (1,), 10, 1e-3
    ),
}  # fmt: skip


def ours(problem, stops, f=None):
    """Run `bdf` as Python; return flag, (t, size, states) of all steps, the solver."""
    n, derive = len(problem.start), f or problem.f
    y = np.array(problem.start, dtype=float)
    allowed = 1 / (TOLERANCE * np.array(problem.big))

    def put(place, values):
        place[: len(values)] = values
        return 0

    def fill(_, t, y, _derivatives, matrix, *_spare):
        values = np.array(problem.jacobian(t, y[:n])).T.ravel()
        np.ctypeslib.as_array(matrix, (n * n,))[:] = values
        return 0

    def evaluate(_, t, y, out):
        values = derive(t, y[:n])
        if values is None:
            return 1
        np.ctypeslib.as_array(out, (n,))[:] = values
        return 0

    def weigh(_, _y, out):
        np.ctypeslib.as_array(out, (n,))[:] = allowed
        return 0

    solver = OwnSolver(n, y.ctypes.data, 0)
    solver.connect(Evaluate(evaluate), Weigh(weigh), Fill(fill))
    solver.restart(0.0, problem.first)
    return (*follow(solver, stops, y), solver)


def cvodes(problem, stops):
    """The same by the library."""
    n = len(problem.start)
    y = np.array(problem.start, dtype=float)
    allowed = 1 / (TOLERANCE * np.array(problem.big))

    def rhs(t, yv, out, _):
        numbers(out)[:] = problem.f(t, numbers(yv))
        return 0

    def weigh(_yv, out, _):
        numbers(out)[:] = allowed
        return 0

    def jacobian(t, yv, _f, matrix, _, *_spare):
        data = library.libraries().cvode.SUNDenseMatrix_Data(matrix)
        values = np.array(problem.jacobian(t, numbers(yv)), dtype=float).T.ravel()
        np.ctypeslib.as_array((ctypes.c_double * (n * n)).from_address(data))[:] = values
        return 0

    kept = RhsFunction(rhs), WeightFunction(weigh), JacobianFunction(jacobian)
    places = [ctypes.cast(function, ctypes.c_void_p).value for function in kept]
    solver = Solver(14, n, y.ctypes.data, Callbacks(*places[:2]), Linear("dense", jacobian=places[2]))
    solver.limit(0.0)
    solver.restart(0.0, problem.first)
    return (*follow(solver, stops, y), solver, kept)


def follow(solver, stops, y):
    """Step to each stop."""
    flag, steps = 0, []
    for stop in stops:
        flag = 0
        while flag == 0:
            flag, t = solver.step(stop)
            steps.append((t, solver.last_step, *y))
    return flag, np.array(steps)


@pytest.mark.parametrize("name", PROBLEMS)
def test_steps_are_cvodes(name):
    problem = PROBLEMS[name]
    stops = [problem.t_end / 3, problem.t_end]
    flag, mine, solver = ours(problem, stops)
    its_flag, its, its_solver, _ = cvodes(problem, stops)
    assert flag == its_flag == step.AT_STOP
    assert len(mine) == len(its) > 50
    assert solver.counts() == its_solver.counts()
    early = slice(0, 150)  # rounding grows from step to step: a millionth at the end, 1e-16 at the start
    assert mine[early] == pytest.approx(its[early], rel=1e-6, abs=1e-8)
    assert mine[:20] == pytest.approx(its[:20], rel=1e-9, abs=1e-12)
    assert mine[-1, 2:] == pytest.approx(its[-1, 2:], abs=10 * TOLERANCE * max(problem.big))


@given(st.integers(1, 8), st.integers(0, 1000))
def test_factors_solve(n, seed):
    random = np.random.default_rng(seed)
    matrix, wanted = random.uniform(-1, 1, (n, n)), random.uniform(-1, 1, n)
    columns, right, swaps = matrix.T.copy().ravel(), matrix @ wanted, np.zeros(n, dtype=np.int64)
    assert newton.factor(n, columns, swaps) == 0
    newton.solve(n, columns, swaps, right)
    assert right == pytest.approx(wanted, abs=1e-12 * np.linalg.cond(matrix))


def test_a_singular_matrix_is_told():
    assert newton.factor(2, np.array([1.0, 2.0, 2.0, 4.0]), np.zeros(2, dtype=np.int64)) == newton.TOO_SLOW


def test_a_pole_ends_with_small_steps():
    """y' = y² from 1 ends at t = 1."""
    problem = Problem(lambda _, y: [y[0] ** 2], lambda _, y: [[2 * y[0]]], (1,), (1,), 2, 1e-3)

    def f(_t, y):
        return [y[0] ** 2] if y[0] < 1e6 else None

    flag, steps, _ = ours(problem, [2.0], f)
    assert flag == memory.NOT_CONVERGED
    assert steps[-1, 0] == pytest.approx(1.0, abs=1e-4)


def test_no_derivatives_at_the_start():
    problem = PROBLEMS["oscillator"]
    flag, _, _ = ours(problem, [1.0], lambda *_: None)
    assert flag == memory.NO_DERIVATIVES


def test_backwards_in_time():
    """The solver looks for the first step itself, which is negative."""
    problem = Problem(lambda _, y: [y[0]], lambda _, __: [[1.0]], (1,), (1,), -3, 0)
    flag, steps, _ = ours(problem, [-3.0])
    assert flag == step.AT_STOP
    assert steps[-1, 2] == pytest.approx(exp(-3), abs=1e-5)


@pytest.mark.parametrize("n", [1, 2, 5, 17, 30])
@pytest.mark.parametrize("fast", [False, True])
def test_native_code_for_each_number_of_states(n, fast):
    """A chain of n stages fed at one end; the matrix exponential by eigenvalues. Both codes, the same numbers."""
    text = f"""STATE u[{n}]
        for i = 1 to {n} | u[i] = 1/i | next
        irule 14 | ERMAX = 1E-7 | DT = 1E-5 | TMAX = 0.5 | NN = 6
        drun
        DYNAMIC
        Vectr d/dt u = 40*(u{{-1}} - 2*u + u{{1}})
        dispt u[1]
    """
    if fast:
        shared_state().routines.fast(n, own=True, smooth=True)
    session = Session(Listener())
    session.erun(Source(text, "chain.src"))
    matrix = 40 * (np.diag([1.0] * (n - 1), 1) + np.diag([1.0] * (n - 1), -1) - 2 * np.eye(n))
    values, vectors = np.linalg.eigh(matrix)
    exact = vectors @ (np.exp(0.5 * values) * (vectors.T @ (1 / np.arange(1, n + 1))))
    quantity = session.values.find("u")
    found = session.values.data[quantity.slot : quantity.slot + n]
    assert found == pytest.approx(exact, abs=1e-6)
    steps = session.runs[-1].steps
    assert steps == STEPS.setdefault(n, steps), "fast code takes the steps of quick code"


STEPS: dict[int, int] = {}


@pytest.mark.parametrize(
    ("lines", "expected"),
    [
        ("", 3 * exp(-2)),
        ("event 1 - x\nx = 3\nend event", 9 * exp(-2)),
        ("every 10, 1\nx = 1\nend event", exp(-1)),
        ("SAMPLE 2\nc = 2", 3 * exp(-3)),
        ("step\nc = 2", 3 * exp(-4)),
        ("d = swtch(t - 1)*x", 3 * exp(-3)),
        ("d = delay(x, 1, 0)", 3 * exp(-2) - 3 * exp(-1)),
    ],
)
def test_code_for_smooth_models_is_used_for_no_others(lines, expected):
    """It asks for nothing that may happen between steps."""
    shared_state().routines.fast(1, own=True, smooth=True)
    text = f"""irule 14 | ERMAX = 1E-8 | DT = 1E-5 | TMAX = 2 | NN = 3 | x = 3 | c = 1
        drun
        DYNAMIC
        d = 0
        {lines if lines[:1] == "d" else ""}
        d/dt x = -c*x - d
        dispt x
        {"" if lines[:1] == "d" else lines}
    """
    session = Session(Listener())
    session.erun(Source(text, "smooth.src"))
    found = session.values.data[session.values.find("x").slot]
    assert found == pytest.approx(expected, rel=1e-5)
