"""The native and the reference back end under rules 9 … 16: the same steps, not only the same solution."""

from __future__ import annotations

import pytest

from tests.integration.stiff_programs import RULES, run
from tests.integration.test_stiff_runs import JACOBIAN, LINEAR, ROBERTSON


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("model", ["linear", "Robertson", "Robertson with JACOBIAN"])
def test_both_back_ends_make_the_same_steps(rule, model):
    text = LINEAR.format(rule=rule)
    if model != "linear":
        parts = ("ARRAY J[3,3]", JACOBIAN) if "JACOBIAN" in model else ("", "")
        text = ROBERTSON.format(rule=rule, script=parts[0], jacobian=parts[1]).replace(
            "TMAX = 40", "TMAX = 0.4"
        )
    native, reference = (run(text, backend)[0].runs[-1] for backend in ("native", "reference"))
    assert native.count == reference.count
    count = native.count
    assert native.rows[:count, :2] == pytest.approx(reference.rows[:count, :2], rel=1e-9, abs=1e-15)
    for counted in ("steps", "rejected", "jacobian_calls", "derivative_calls", "order"):
        assert getattr(native, counted) == getattr(reference, counted), counted
