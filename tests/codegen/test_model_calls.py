"""What native solvers do with derivatives that are not finite."""

from __future__ import annotations

import ctypes

import numpy as np
import pytest

from desire_tui.engine.codegen.jit.compiler import compile_text
from desire_tui.engine.codegen.plain_python.kinds import of_declaration
from desire_tui.engine.codegen.plain_python.program import Module, write_program
from desire_tui.engine.codegen.plain_python.surroundings import Outside
from desire_tui.engine.codegen.stiff import model_calls
from desire_tui.engine.codegen.stiff.solver_routines import _TEXTS
from desire_tui.engine.integration.problem import FUNCTIONS, SolverProblem


@pytest.fixture(scope="module")
def evaluate():
    pointers = {name: of_declaration(*kinds, "") for name, kinds in FUNCTIONS.items()}
    outside = Outside({"SolverProblem": SolverProblem}, pointers)
    text = write_program([Module(_TEXTS[model_calls], vars(model_calls))], outside, "test_")
    code = compile_text(text, level=1)
    nothing = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_void_p, ctypes.c_void_p)(lambda _memory, _out: 0)
    address, real = ctypes.c_void_p, ctypes.c_double
    native = ctypes.CFUNCTYPE(ctypes.c_int32, address, real, address, address)(code.address("test_evaluate"))

    def run(derivatives):
        """Return result and suspect for derivatives that the model has written already."""
        given, values = np.array(derivatives, dtype=float), np.zeros(3)
        problem = SolverProblem(n=given.size, values=values.ctypes.data, suspect=-1)
        problem.derivatives = ctypes.cast(nothing, address).value
        result = native(ctypes.addressof(problem), 1.5, given.ctypes.data, given.ctypes.data)
        assert problem.derivative_calls == 1
        assert 1.5 in values
        return result, problem.suspect

    run.keep = code, nothing
    return run


@pytest.mark.parametrize("n", range(1, 10))
def test_each_place_is_looked_at(evaluate, n):
    assert evaluate([1.0] * n) == (0, -1)
    for place in range(n):
        for wild in (np.inf, -np.inf, np.nan):
            assert evaluate([1.0] * place + [wild] + [1.0] * (n - place - 1)) == (1, place)


def test_finite_numbers_whose_sum_is_not(evaluate):
    assert evaluate([1.7e308, 1.7e308]) == (0, -1)
    assert evaluate([1.7e308] * 5) == (0, -1)
    assert evaluate([1.7e308] * 5 + [np.inf, 1.0]) == (1, 5)
    assert evaluate([np.inf, -np.inf]) == (1, 1)
