"""Conditions of events that are computed ahead of them, in parts, stand outside of every block."""

from __future__ import annotations

import pytest

from tests.runtime.running import session_for

CHAIN = " + ".join(["0.001*x"] * 3000)
"""So long that its parts are computed one after the other."""
PROGRAM = "x = 1 | TMAX = 3 | DT = 0.01 | NN = 4 | irule 3\ndrun\nDYNAMIC\nd/dt x = 1\n{before}event {chain} - 7.5\nn = n + 1\n"


@pytest.mark.parametrize("before", ["", "every 100\nb = 1\n", "event -x\nb = 1\n"])
def test_a_long_condition_behind_another_block(before):
    session = session_for(PROGRAM.format(before=before, chain=CHAIN))
    assert session.values.cells[session.values.find("n").slot] == 1.0
