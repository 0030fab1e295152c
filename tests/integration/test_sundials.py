"""The library, one solver object, and what happens where SUNDIALS is missing or another version."""

from __future__ import annotations

import ctypes
import gc
from math import cos

import numpy as np
import pytest

from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.integration.callbacks import numbers
from desire_tui.engine.integration.sundials import library
from desire_tui.engine.integration.sundials.linear import Linear, positions
from desire_tui.engine.integration.sundials.signatures import (
    TSTOP_RETURN,
    JacobianFunction,
    RhsFunction,
    WeightFunction,
)
from desire_tui.engine.integration.sundials.solver import Callbacks, Solver

LINEARS = ("fixed-point", "dense", "dense", "diagonal")


def address(function):
    return ctypes.cast(function, ctypes.c_void_p).value


def cosine(rule, linear, t_end=2.0, tolerance=1e-9):
    """Prothero and Robinson's problem, y' = −50·(y − cos t) − sin t: y = cos t from y(0) = 1."""
    y = np.array([1.0])

    def rhs(t, yv, out, _user):
        numbers(out)[0] = -50.0 * (numbers(yv)[0] - cos(t)) - np.sin(t)
        return 0

    def weights(_y, w, _user):
        numbers(w)[0] = 1.0 / tolerance
        return 0

    def jacobian(_t, _y, _f, matrix, _user, *_spare):
        data = library.libraries().cvode.SUNDenseMatrix_Data(matrix)
        ctypes.c_double.from_address(data).value = -50.0
        return 0

    kept = RhsFunction(rhs), WeightFunction(weights), JacobianFunction(jacobian)
    if linear.kind == "dense" and rule % 4 == 2:
        linear = Linear("dense", jacobian=address(kept[2]))
    solver = Solver(rule, 1, y.ctypes.data, Callbacks(address(kept[0]), address(kept[1])), linear)
    solver.limit(0.0)
    solver.restart(0.0, 1e-4)
    t, flag = 0.0, 0
    while flag == 0:
        flag, t = solver.step(t_end)
    return flag, t, y[0], solver, kept


@pytest.mark.parametrize("rule", range(9, 17))
def test_all_eight_rules_follow_the_exact_solution(rule):
    flag, t, y, solver, _ = cosine(rule, Linear(LINEARS[(rule - 9) % 4]))
    assert flag == TSTOP_RETURN
    assert t == 2.0
    assert y == pytest.approx(cos(2.0), abs=3e-7)
    counts = solver.counts()
    assert counts.steps > 10
    assert 1 <= counts.order <= (12 if rule <= 12 else 5)


def test_a_better_tolerance_gives_a_better_solution():
    errors = [abs(cosine(14, Linear("dense"), tolerance=tol)[2] - cos(2.0)) for tol in (1e-4, 1e-7, 1e-10)]
    assert errors[0] > errors[1] > errors[2]
    assert errors[2] < 1e-8


def test_the_first_step_is_what_was_asked_for():
    _, _, _, solver, _kept = cosine(14, Linear("dense"), tolerance=0.01)
    solver.restart(0.0, 3e-5)
    _, t = solver.step(2.0)
    assert t == pytest.approx(3e-5, rel=1e-9)


def test_no_step_is_longer_than_the_limit():
    _, _, _, solver, _kept = cosine(14, Linear("dense"))
    solver.limit(0.01)
    solver.restart(0.0, 1e-4)
    before, longest = 0.0, 0.0
    flag = 0
    while flag == 0:
        flag, t = solver.step(1.0)
        longest, before = max(longest, t - before), t
    assert 0.009 < longest <= 0.01 * (1 + 1e-9)


def test_solvers_are_given_back():
    for _ in range(50):
        cosine(14, Linear("dense"), t_end=0.01)[3].free()
    solver = cosine(15, Linear("dense"), t_end=0.01)[3]
    solver.free()
    solver.free()  # twice is harmless
    gc.collect()


def test_positions_are_where_sundials_keeps_the_entries():
    """Write row·100 + column through `positions`, read through SUNDIALS' own accessors' layout (columns)."""
    n, lower, upper = 6, 2, 1
    rows = np.array(
        [r for c in range(n) for r in range(max(0, c - upper), min(n, c + lower + 1))], dtype=np.int32
    )
    columns = np.array(
        [c for c in range(n) for r in range(max(0, c - upper), min(n, c + lower + 1))], dtype=np.int32
    )
    loaded = library.libraries()
    context = ctypes.c_void_p()
    loaded.core.SUNContext_Create(0, ctypes.byref(context))
    cvode = loaded.cvode
    cvode.SUNBandMatrix_Column.restype = ctypes.POINTER(ctypes.c_double)
    cvode.SUNBandMatrix_Column.argtypes = (ctypes.c_void_p, ctypes.c_int32)
    matrix = cvode.SUNBandMatrix(n, upper, lower, context)
    data = cvode.SUNBandMatrix_Data(matrix)
    places = positions(Linear("band", lower=lower, upper=upper), n, rows, columns)
    for row, column, place in zip(rows, columns, places, strict=True):
        ctypes.c_double.from_address(data + 8 * int(place)).value = row * 100 + column
    for row, column in zip(rows, columns, strict=True):
        # SUNBandMatrix_Column points at the diagonal element: element (i, j) is at [i − j]
        assert cvode.SUNBandMatrix_Column(matrix, int(column))[int(row) - int(column)] == row * 100 + column
    loaded.core.SUNMatDestroy(matrix)


@pytest.fixture
def forget():
    library.libraries.cache_clear()
    yield
    library.libraries.cache_clear()


def test_another_version_is_refused(monkeypatch, forget):
    monkeypatch.setattr(library, "WANTED", (6, 1))
    with pytest.raises(DesireError) as caught:
        library.libraries()
    diagnostic = caught.value.diagnostics[0]
    assert diagnostic.code == 461
    assert "6.1" in diagnostic.message
    assert "7.9" in diagnostic.message


def test_wide_indices_are_refused(monkeypatch, forget):
    monkeypatch.setattr(library, "_indices_are_32_bit", lambda _loaded: False)
    with pytest.raises(DesireError) as caught:
        library.libraries()
    assert caught.value.diagnostics[0].code == 461


@pytest.mark.parametrize("kind", ["dense", "band", "sparse", "diagonal", "fixed-point"])
def test_a_solver_that_was_never_used_can_be_freed(kind):
    """SuperLU_MT's own clean-up crashes then (SUNDIALS 7.9)."""
    y = np.ones(300)
    function = RhsFunction(lambda *_: 0), WeightFunction(lambda *_: 0)
    linear = Linear(kind, lower=1, upper=1, nonzeros=900)
    callbacks = Callbacks(address(function[0]), address(function[1]))
    Solver(14, 300, y.ctypes.data, callbacks, linear).free()
