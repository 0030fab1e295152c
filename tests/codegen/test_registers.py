"""A small model's own loop, its scalars in registers: what arrays share with them, and which state is checked."""

from __future__ import annotations

import numpy as np
import pytest

from desire_tui.engine.codegen.backend import NativeBackend
from desire_tui.engine.lowering.lowering import lower
from desire_tui.engine.runtime.run_memory import Ended
from desire_tui.engine.source import Source
from desire_tui.engine.syntax.parse import parse
from desire_tui.engine.values import T, Values
from tests.codegen.conftest import improve, memory_for


def finished(body, rule, storage, settings, arrays=None, **numbers):
    """Run a segment in one kind of code; return its memory and rows."""
    values = Values()
    for name, size in (arrays or {}).items():
        values.array(name, (size,))
    for name, number in numbers.items():
        values.assign(values.scalar(name).slot, number)
    values.assign(T, 0.0)
    segment = lower(parse(Source(f"DYNAMIC\n{body}\n".replace("\\\n", "\n"))), None, values)
    model = NativeBackend().model(segment, rule, values)
    if storage != "quick":
        improve(model)
    memory, rows = memory_for(values, segment, **settings)
    assert model.advance(memory) is Ended.TMAX
    return memory, rows[: memory.row]


def test_elements_that_store_fills_are_the_scalars_that_are_read(storage):
    """x = 7 + t at t = 0, 1, 2: X[1] is 7 from the first point on, X[3] is 9 at the third."""
    body = "d/dt x = 1\nstore X = x\nfirst = X[1]\nlast = X[3]\ndispt first, last"
    settings = {"t_max": 2.0, "dt": 1.0, "nn": 3}
    _, rows = finished(body, 2, storage, settings, {"X": 3}, x=7.0)
    assert rows[:, 1:].tolist() == [[7, 0], [7, 0], [7, 9]]


@pytest.mark.parametrize(("checked", "rejected"), [(1, 0), (2, 1), (3, 0)])
def test_the_state_that_is_checked(checked, rejected, storage):
    """Only y jumps: from 0 to 1 between t = 0 and 1; rule 7 sees DT/2 = 0.5 there, and 0 up to half of the step."""
    body = "d/dt x = 1\nd/dt y = 0.5 + 0.5*tanh(1000*(t - 0.7))\nd/dt z = 1\ndispt y"
    settings = {
        "t_max": 1.0, "dt": 1.0, "nn": 2, "checked": checked, "error_max": 0.4, "error_min": 0.0, "dt_min": 0.01
    }  # fmt: skip
    memory, rows = finished(body, 7, storage, settings, x=0.0, y=0.0, z=0.0)
    assert memory.rejected == rejected
    assert np.isclose(rows[-1, 1], 0.25 if rejected else 0.5)
