"""A run of scalar statements that read what one of them sets stays as it is written."""

from __future__ import annotations

import pytest

from desire_tui.engine.codegen.scalar.rerolling import Rolled, roll
from desire_tui.engine.lowered.expressions import Load, Op
from desire_tui.engine.lowered.statements import Set, Where
from desire_tui.engine.source import Span
from tests.codegen.conftest import run

HERE = Where(Span(0, 0), None)


@pytest.mark.parametrize(("read", "loops"), [(499, 1), (500, 0), (531, 0), (532, 1)])
def test_one_number_for_all(read, loops):
    """Slots 500 … 531 are set, each from the same slot `read` and a neighbour's."""
    statements = [Set(500 + k, Op("add", (Load(read), Load(900 + k))), HERE) for k in range(32)]
    assert sum(isinstance(found, Rolled) for found in roll(statements, 4)) == loops


@pytest.mark.parametrize("backend", ["native", "reference"])
def test_the_first_one_is_read_by_all(backend):
    """y[1] = y[1] + x[1] = 6, then y[k] = y[1] + x[k] = 6 + k."""
    lines = "\n".join(f"y[{k}] = y[1] + x[{k}]" for k in range(1, 33))
    script = "ARRAY x[32], y[32] | y[1] = 5\nfor k = 1 to 32 | x[k] = k | next\nNN = 2\ndrun\nDYNAMIC\nif 1.5 - t\n"
    made = run(f"{script}{lines}\nend if\n", backend)
    assert made.array("y").tolist() == [6.0, *(6.0 + k for k in range(2, 33))]
