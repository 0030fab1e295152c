"""A switching just behind t = 0 is found in some dozens of looks, though 1,074 halvings lead from 1 to the next number."""

from __future__ import annotations

from pathlib import Path
from unittest.mock import patch

import pytest

from desire_tui.engine.integration.switching import ahead, watch
from desire_tui.engine.runtime.moments import locate
from tests.programs.execution import execute

PROGRAM = """\
irule {rule} | ERMAX = 1e-4 | DT = 0.1 | TMAX = 1 | NN = 3
x = 0
drun
DYNAMIC
{model}
dispt x
"""
BY_STATE = "d/dt x = 1 + swtch(x)"
BY_T = "d/dt x = swtch(t)"
EVENT = "d/dt x = 1\nevent x | n = 1 | end event"
LOOKS_MOST = 400


@pytest.mark.parametrize(
    ("rule", "model", "owner", "looks"),
    [
        (4, BY_STATE, watch, "has_switched"),
        (4, BY_T, ahead, "over"),
        (14, BY_T, ahead, "over"),
        (4, EVENT, locate, "go_to"),
        (14, EVENT, locate, "go_to"),
    ],
)
def test_few_looks(rule, model, owner, looks):
    with patch.object(owner, looks, autospec=True, side_effect=getattr(owner, looks)) as look:
        outcome = execute(PROGRAM.format(rule=rule, model=model), "reference", Path.cwd())
    assert outcome.error is None
    assert 0 < look.call_count < LOOKS_MOST
    native = execute(PROGRAM.format(rule=rule, model=model), "native", Path.cwd())
    assert native.runs[0].count == outcome.runs[0].count == 3
    assert abs(native.quantities["x"] - outcome.quantities["x"]) < 1e-9
