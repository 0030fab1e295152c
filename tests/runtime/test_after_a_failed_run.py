"""A run that failed took no last sample: the next one begins with a point of its own, which is no joint."""

from __future__ import annotations

import pytest

from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source
from tests.runtime.running import value

TEXT = """
ARRAY X[20]
TMAX = 4 | NN = 5 | DT = 1 | DTMIN = 0.3 | irule 4
k = 1e9
drun
DYNAMIC
d/dt x = 1 + k*(1 + tanh(1000*(t - 2.7)))
store X = x
OUT
points = points + 1
SAMPLE 1
samples = samples + 1
"""


@pytest.mark.parametrize("backend", ["native", "reference"])
def test_the_next_run_begins_with_a_point(backend):
    """Steps 1, 1, then 1, 0.5 and so on fail at the jump: points 0, 1, 2 have been, and 5 more come from t = 2.5 on."""
    session = Session(backend=backend)
    text = TEXT.replace("k = 1e9", "k = 1e9 | points = 0 | samples = 0")
    with pytest.raises(DesireError) as failed:
        session.erun(Source(text.strip() + "\n", "t.src"))
    assert failed.value.diagnostics[0].code == 94
    assert (value(session, "points"), value(session, "samples")) == (3, 3)
    session.execute("k = 0")
    session.execute("drun")
    assert (value(session, "points"), value(session, "samples")) == (8, 8)
    stored = session.values.view(session.values.find("X"))[:8].tolist()
    assert stored[:3] == pytest.approx([0, 1, 2])
    assert stored[3] == pytest.approx(stored[4] - 1)
    assert stored[3] == pytest.approx(value(session, "x") - 4)
