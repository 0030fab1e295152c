"""Rules 1 to 8: native code and the reference back end add the stages in the same way, to the last bit."""

from __future__ import annotations

import numpy as np
import pytest

from tests.integration.stiff_programs import run

FEW = "d/dt x = 1.3 - x*x*y\nd/dt y = x*y - 0.7*y\n"
MANY = "".join(f"d/dt x{i} = 1.{i} - x{i}*x{i} + 0.1*x{(i + 1) % 40}\n" for i in range(40))
"""More than the reference writes out as Python text."""


@pytest.mark.parametrize("rule", [1, 2, 3, 4, 5, 7, 8])
@pytest.mark.parametrize(("equations", "shown"), [(FEW, "x, y"), (MANY, "x0, x1")], ids=["few", "many"])
def test_the_same_bits(rule, equations, shown):
    text = (
        f"irule {rule} | DT = 0.03 | TMAX = 3 | NN = 51 | ERMAX = 1e-4\n"
        "x = 1/3 | y = 2/3 | x0 = 1/7\n"
        f"drun\nDYNAMIC\n{equations}dispt {shown}\n"
    )
    native, reference = (run(text, backend)[0].runs[-1] for backend in ("native", "reference"))
    assert native.count == reference.count
    assert np.array_equal(native.rows[: native.count], reference.rows[: reference.count])
