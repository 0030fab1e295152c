"""Derived Jacobians against formulas worked out by hand, entry by entry; the pattern holds all of them."""

from __future__ import annotations

import numpy as np
import pytest

from desire_tui.engine.passes.sparsity import sparsity_pattern
from tests.passes.test_differentiate import Model, program

SCRIPT = """
ARRAY big[4], c[2], m[2], W[2, 2], A[2, 2], a[2], b[2], F[2, 2], U[2], V[2]
STATE x[2]
c[1] = 3 | c[2] = 5 | m[2] = 1 | x[1] = 0.25 | x[2] = 0.75
F[1, 1] = 1 | F[1, 2] = 3 | F[2, 1] = 2 | F[2, 2] = 8
U[2] = 1 | V[2] = 1
"""
X, Y = 0.25, 0.75

CASES = {
    # z' = Σ c·2x − Σ x·2x
    "sum of products": (
        "Vector a = 2*x\nDOT s = c*a - x*a\nVectr d/dt x = 0*c\nd/dt z = s",
        [[0, 0, 0], [0, 0, 0], [6 - 4 * X, 10 - 4 * Y, 0]],
    ),
    # W[i, k] = x[i]·c[k]; (W%·c)[k] = c[k]·Σ x[i]·c[i]
    "transposed matrix that depends on the states": (
        "MATRIX W = x*c\nVectr d/dt x = W%*c\nd/dt z = 0",
        [[9, 15, 0], [15, 25, 0], [0, 0, 0]],
    ),
    # (W·c)[i] = x[i]·Σ c²
    "matrix that depends on the states": (
        "MATRIX W = x*c\nVectr d/dt x = W*c\nd/dt z = 0",
        [[34, 0, 0], [0, 34, 0], [0, 0, 0]],
    ),
    # the mask makes a[2] = 0
    "masked vector": (
        "Vector a = [m] x^2\nVectr d/dt x = a\nd/dt z = 0",
        [[2 * X, 0, 0], [0, 0, 0], [0, 0, 0]],
    ),
    # F = 1 + u + 2v + 4uv over the unit square, linear in each of u, v
    "table of two arguments": (
        "Vectr d/dt x = 0*c\nd/dt z = func2(x[1], x[2]; F, U, V)",
        [[0, 0, 0], [0, 0, 0], [1 + 4 * Y, 2 + 4 * X, 0]],
    ),
    "table of its second argument": (
        "Vectr d/dt x = 0*c\nd/dt z = func2(0.5, x[2]; F, U, V)",
        [[0, 0, 0], [0, 0, 0], [0, 4, 0]],
    ),
    # y = x1, then y = y², then y = y³: x1⁶
    "a variable set again from itself": (
        "Vectr d/dt x = 0*c\ny = x[1]\ny = y*y\ny = y*y*y\nd/dt z = y",
        [[0, 0, 0], [0, 0, 0], [6 * X**5, 0, 0]],
    ),
    "reciprocals, limiters and powers": (
        "Vectr d/dt x = 0*c\nd/dt z = recip(x[1]) + sat(x[2]) + min(x[1], x[2])*2 + 2^x[2]",
        [[0, 0, 0], [0, 0, 0], [2 - X**-2, 1 + np.log(2) * 2**Y, 0]],
    ),
    # an element in the middle is set anew, the last one is the vector's still
    "an element behind one that is set anew": (
        "Vector big = 3*x[1]\nbig[2] = x[2]\nVectr d/dt x = 0*c\nd/dt z = big[4] + 10*big[2]",
        [[0, 0, 0], [0, 0, 0], [3, 10, 0]],
    ),
    # its first element is the other state
    "an element that is set behind its vector": (
        "Vector a = 3*x\na[1] = x[2]\nVectr d/dt x = a\nd/dt z = 0",
        [[0, 1, 0], [0, 3, 0], [0, 0, 0]],
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
def test_entries(name):
    body, expected = CASES[name]
    model = Model(program(SCRIPT, body))
    found = model.exact(np.array([X, Y, 0.0]))
    assert found == pytest.approx(np.array(expected, dtype=float), rel=1e-9, abs=1e-9)
    pattern = np.zeros((3, 3), dtype=bool)
    pattern[sparsity_pattern(model.segment)] = True
    assert pattern[found != 0].all()


BRANCHES = "y = x[1]\nif x[2] - 0.5\ny = 2*x[2]\nend if\nVectr d/dt x = 0*c\nd/dt z = y"


def test_a_branch_that_is_not_taken_leaves_what_was_there():
    """y is x[1] or 2·x[2]: z' may depend on both."""
    model = Model(program(SCRIPT, BRANCHES))
    rows, columns = sparsity_pattern(model.segment)
    assert {(2, 0), (2, 1)} <= set(zip(rows.tolist(), columns.tolist(), strict=True))
