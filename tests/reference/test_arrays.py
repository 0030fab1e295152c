"""Vector and matrix statements against NumPy and closed formulas."""

from __future__ import annotations

import numpy as np
import pytest

from tests.reference.runs import array, run, value

A = np.array([[1, 3, 50, 3], [2, 3, 0, -1], [0, -1, 2, 0], [-90, 0, 1, 3]], dtype=float)
X = np.array([1.0, 2.0, 3.0, 4.0])
SCRIPT = (
    "NN = 2 | TMAX = 1 | n = 4\nARRAY A[n,n], x[n], y[n], z[n], P[3,n], u[3], W[3,n], M[3,n]\n"
    "data 1,3,50,3; 2,3,0,-1; 0,-1,2,0; -90,0,1,3\nread A\n"
    "for i = 1 to n | x[i] = i | next\nfor i = 1 to 3 | for k = 1 to n | P[i,k] = 10*i + k | next | next\n"
    "u[1] = -1 | u[2] = 0.5 | u[3] = 2\n"
)
P = np.array([[10 * i + k for k in range(1, 5)] for i in range(1, 4)], dtype=float)
U = np.array([-1, 0.5, 2])


def once(body: str, script: str = ""):
    """Run `body` in exactly one pass."""
    return run(f"{SCRIPT}{script}t = 0\ndrun\nDYNAMIC\nOUT\nif 0.5 - t\n{body}")


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("A*x", A @ X),
        ("A%*x", A.T @ X),
        ("2*A*x - tanh(A%*x/100)*x", 2 * A @ X - np.tanh(A.T @ X / 100) * X),
        ("x{1}", [2, 3, 4, 0]),
        ("x{-1}", [0, 1, 2, 3]),
        ("x{9} + x{-9} + 1", [1, 1, 1, 1]),
        ("x{0.6}", [2, 3, 4, 0]),
        ("sin(x)*cos(x)^2 + 1/x", np.sin(X) * np.cos(X) ** 2 + 1 / X),
        ("x^3 - x^-1", X**3 - 1 / X),
        ("comp(x - 2.5, -1, x)", [-1, -1, 3, 4]),
        ("max(x, 2.5) - min(x, 2.5)", [1.5, 0.5, 0.5, 1.5]),
        ("deadz(x - 2) + round(x/2)", [1, 1, 2, 3]),
        ("P%*u", P.T @ U),
    ],
)
def test_vector_expressions(expression, expected):
    session = once(f"Vector y = {expression}")
    assert array(session, "y") == pytest.approx(np.asarray(expected, dtype=float), rel=1e-14)


def test_rows_of_a_pattern_matrix():
    for row, expected in ((1, 0), (3, 2), (4, 0), (6.9, 2)):
        session = once("Vector y = P#", f"iRow = {row}\n")
        assert list(array(session, "y")) == list(P[expected])


def test_delta_mask_and_largest():
    session = once("Vectr delta x = 10*x\nVector y = [x] 5\nVector z = x - x^2/55")
    assert list(array(session, "x")) == [11, 22, 33, 44]
    assert not array(session, "y").any()
    session = once("Vector y^ = (x - 1)*(4 - x)")
    assert list(array(session, "y")) == [0, 0, 2, 0]  # a tie: the highest index
    session = once("Vector y = [z] x", "z[2] = 1\n")
    assert list(array(session, "y")) == [1, 0, 3, 4]


def test_in_place_shift_makes_a_tapped_delay_line():
    session = run("NN = 6 | ARRAY x[4]\ndrun\nDYNAMIC\nVector x = x{-1}\nx[1] = t")
    assert list(array(session, "x")) == [6, 5, 4, 3]


@pytest.mark.parametrize(
    ("statement", "expected"),
    [
        ("MATRIX W = u*x", np.outer(U, X)),
        ("MATRIX W = 2*u*x - P/2", 2 * np.outer(U, X) - P / 2),
        ("MATRIX W = u & x", np.minimum.outer(U, X)),
        ("MATRIX W = P*P - cos(P)", P * P - np.cos(P)),
        ("MATRIX W = recip(P)", 1 / P),
        ("MATRIX W = (P - 10)*0.5; 1, 10", np.clip((P - 10) * 0.5, 1, 10)),
        ("DELTA W = P\nDELTA W = u*x; 0, 20", np.clip(P + np.outer(U, X), 0, 20)),
        ("MATRIX W = 7\nMATRIX W = [M] 3*P", np.where(np.arange(12).reshape(3, 4) == 5, 3 * P, 7)),
    ],
)
def test_matrices(statement, expected):
    session = once(statement, "M[2,2] = 1\n")
    assert array(session, "W") == pytest.approx(expected, rel=1e-14)


def test_dot_products():
    session = once("DOT a = x*x + x*1 - x*A*x\nDOT b = u*P*x\nAVG c = x*1\nDOT e = u*u + x*P%*u")
    assert value(session, "a") == pytest.approx(X @ X + X.sum() - X @ A @ X)
    assert value(session, "b") == pytest.approx(U @ P @ X)
    assert value(session, "c") == 2.5
    assert value(session, "e") == pytest.approx(U @ U + X @ P.T @ U)


def test_vectors_draw_from_the_last_element_down():
    """Two draws an element, from left to right; SEED 1 gives the sequence of models.md 4.3.4."""
    sequence = [-0.9167393105, -0.09101511054, 0.6696344363]
    session = once("y[1] = ran()\ny[2] = ran()\ny[3] = ran()", "SEED 1\n")
    assert list(array(session, "y")[:3]) == pytest.approx(sequence, rel=1e-9)
    one = array(once("Vector y = ran() - 2*ran()", "SEED 1\n"), "y")
    pieces = [f"y[{i}] = ran()\ny[{i}] = y[{i}] - 2*ran()" for i in (4, 3, 2, 1)]
    two = array(once("\n".join(pieces), "SEED 1\n"), "y")
    assert list(one) == list(two)


def test_a_matrix_draws_row_by_row_from_the_end():
    session = once("MATRIX W = ran()", "SEED 7\n")
    draws = once(
        "\n".join(f"z[1] = ran()\nW[{i},{k}] = z[1]" for i in (3, 2, 1) for k in (4, 3, 2, 1)), "SEED 7\n"
    )
    assert (array(session, "W") == array(draws, "W")).all()


def test_normal_numbers_have_the_right_moments():
    session = run("NN = 2 | n = 20000 | ARRAY x[n] | SEED 5\nt = 0\ndrun\nDYNAMIC\nVector x = gauss(0)")
    x = array(session, "x")
    assert abs(x.mean()) < 0.03
    assert abs(x.std() - 1) < 0.03


def test_an_argument_that_draws_is_drawn_once():
    session = once("y[1] = sq(ran())", "SEED 1\nFUNCTION sq(p$) = p$*p$\n")
    assert array(session, "y")[0] == pytest.approx(0.9167393105**2, rel=1e-9)


def test_a_linear_system_is_its_matrix_exponential():
    from scipy.linalg import expm

    session = run(
        "irule 3\nTMAX = 1 | DT = 0.001 | NN = 11 | STATE s[3] | ARRAY B[3,3]\n"
        "data -1,2,0; 0,-3,1; 1,0,-2\nread B\ns[1] = 1\ndrun\nDYNAMIC\nVectr d/dt s = B*s"
    )
    exact = expm(np.array([[-1, 2, 0], [0, -3, 1], [1, 0, -2]], dtype=float)) @ [1, 0, 0]
    assert array(session, "s") == pytest.approx(exact, rel=1e-11)


def test_elements_override_a_vector_derivative():
    session = run(
        "TMAX = 1 | DT = 0.1 | NN = 2 | STATE s[3]\ndrun\nDYNAMIC\nVectr d/dt s = 1\nd/dt s[2] = -1"
    )
    assert array(session, "s") == pytest.approx([1, -1, 1])


def test_matrix_differential_equation_through_a_view():
    session = run(
        "irule 3\nTMAX = 4 | DT = 0.01 | NN = 41 | STATE W[2,3] = v\nfor i = 1 to 6 | v[i] = 3 | next\n"
        "drun\nDYNAMIC\nVectr d/dt v = -0.5*v + 2*cos(t)"
    )
    assert array(session, "W") == pytest.approx(np.full((2, 3), -1.436061266), rel=1e-8)


def test_tables():
    session = once(
        "y[1] = func1(1.5; F)\ny[2] = func1(-9; F)\ny[3] = func1(9; F)\nfunc q = F(2.25\ny[4] = q\nVector z = func1(x - 1; F)",
        "ARRAY X[3] + Y[3] = F\nX[1] = 0 | X[2] = 1 | X[3] = 3 | Y[1] = 5 | Y[2] = 7 | Y[3] = -1\n",
    )
    assert list(array(session, "y")) == pytest.approx([5, 5, -1, 2])
    assert list(array(session, "z")) == pytest.approx([5, 7, 3, -1])
    session = once(
        "y[1] = func2(0.5, 15; G, X, Y)\ny[2] = func2(9, 9; G, X, Y)\nfunc2 q = G(0.25, 10; X, Y\ny[3] = q",
        "ARRAY G[2,3], X[2], Y[3]\nX[2] = 1 | Y[1] = 10 | Y[2] = 20 | Y[3] = 40\n"
        "data 1,2,3; 5,8,13\nread G\n",
    )
    assert list(array(session, "y")[:3]) == pytest.approx([4, 5, 2])
