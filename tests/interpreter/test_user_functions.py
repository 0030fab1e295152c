"""The program's FUNCTIONs over whole arrays in scripts: element by element, as in DYNAMIC segments."""

from __future__ import annotations

import numpy as np

from tests.interpreter.stand_in import run

HEAD = "ARRAY x[4], y[4], A[2,3], B[2,3]\ndata 1,2,3,4, 1,2,3,4,5,6 | read x, A | k = 3\n"
X, A = np.arange(1.0, 5.0), np.arange(1.0, 7.0).reshape(2, 3)


def view(host, name):
    return host.values.view(host.values.find(name))


def test_vectors_matrices_scalars_and_program_variables():
    host = run(
        f"{HEAD}FUNCTION f(a$, b$) = a$^2 - k*b$\nVector y = 2*f(x, x + 1) + f(2, 1)\nMATRIX B = f(A, k)"
    )
    np.testing.assert_array_equal(view(host, "y"), 2 * (X**2 - 3 * (X + 1)) + 1)
    np.testing.assert_array_equal(view(host, "B"), A**2 - 9)


def test_functions_of_functions():
    host = run(f"{HEAD}FUNCTION g(a$) = 1/a$\nFUNCTION f(a$) = g(a$ + 1) - a$\nVector y = f(g(x))")
    inner = 1 / X
    np.testing.assert_array_equal(view(host, "y"), 1 / (inner + 1) - inner)


def test_an_array_that_the_body_uses_as_one_is_passed_whole():
    host = run(
        "ARRAY F[4], x[3], y[3]\ndata 0,10, 0,100, 0,5,20 | read F, x\n"
        "FUNCTION f(a$, t$) = func1(a$; t$) + t$[4]\nVector y = f(x, F)"
    )
    np.testing.assert_array_equal(view(host, "y"), [100, 150, 200])


def test_random_draws_go_from_the_last_element_to_the_first():
    drawn = "FUNCTION noisy(a$) = a$ + ran()\nARRAY y[3], z[3]\n"
    host = run(f"{drawn}SEED 7 | Vector y = noisy(z)\nSEED 7\nfor i = 1 to 3\nz[4 - i] = ran()\nnext")
    np.testing.assert_array_equal(view(host, "y"), view(host, "z"))
