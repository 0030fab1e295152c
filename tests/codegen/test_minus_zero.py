"""-0 is not 0: neither when neighbours are compared nor when numbers are written into the code."""

from __future__ import annotations

import numpy as np
import pytest

from desire_tui.engine.codegen.scalar.rerolling import Rolled, roll
from desire_tui.engine.lowered.expressions import Const, Load, Op
from desire_tui.engine.lowered.statements import Set, Where
from desire_tui.engine.source import Span
from tests.codegen.conftest import run

HERE = Where(Span(0, 0), None)


@pytest.mark.parametrize(
    ("zeros", "loops"), [([0.0] * 64, 1), ([-0.0] * 64, 1), ([0.0] * 32 + [-0.0] * 32, 2)]
)
def test_runs_of_one_shape_end_where_the_sign_of_a_zero_changes(zeros, loops):
    statements = [Set(500 + k, Op("add", (Load(900 + k), Const(zero))), HERE) for k, zero in enumerate(zeros)]
    assert sum(isinstance(found, Rolled) for found in roll(statements, 4)) == loops


@pytest.mark.parametrize("backend", ["native", "reference"])
def test_a_sum_of_negative_zeros_is_one(backend):
    """x + (-0) is -0 for x = -0 and x + 0 is 0: 32 lines of the one, then 32 of the other."""
    lines = [f"y[{k}] = x[{k}] + (-0)" if k <= 32 else f"y[{k}] = x[{k}] + 0" for k in range(1, 65)]
    made = run(
        "ARRAY x[64], y[64] | z = 0 | NN = 2\ndrun\nDYNAMIC\nVector x = -z\n" + "\n".join(lines), backend
    )
    assert np.signbit(made.array("x")).all()
    assert np.signbit(made.array("y")).tolist() == [True] * 32 + [False] * 32
