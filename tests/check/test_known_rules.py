"""What the check says of a segment depends on its integration rule, if the script's text tells that."""

from __future__ import annotations

import pytest

from desire_tui.engine.check.checker import check
from desire_tui.engine.syntax.parse import parse
from tests.lowering.programs import source

NOISE = "\nDYNAMIC\nd/dt x = ran() - x\ndispt x\n"
DELAY = "\nDYNAMIC\nd/dt x = -delay(x, 1)\ndispt x\n"
WHITE = "\nDYNAMIC\nd/dt x = white(1) - x\ndispt x\n"
TABLES = "\nDYNAMIC\nd/dt x = func2(x, t; F, G, H)\ndispt x\n"
SMOOTH = "\nDYNAMIC\nd/dt x = sinc(x) - abs(x)\ndispt x\n"


def found(script, body):
    return [(d.code, d.severity) for d in check(parse(source(script + body)))]


@pytest.mark.parametrize(
    ("script", "body", "problems"),
    [
        ("TMAX = 1 | drun", NOISE, [(489, "warning")]),
        ("TMAX = 1 | irule 2 | drun", NOISE, [(489, "warning")]),
        ("TMAX = 1 | irule 4 | drun", NOISE, [(489, "error")]),
        ("TMAX = 1 | irule 4 | drun | irule 2 | drun", NOISE, [(489, "warning")]),  # one of them is wrong
        ("TMAX = 1 | drun | irule 4 | drun", NOISE, [(489, "warning")]),  # the first run has rule 1
        ("TMAX = 1 | k = 4 | irule k | drun", NOISE, [(489, "warning")]),
        ("TMAX = 1 | irule 99 | drun", NOISE, [(489, "warning")]),
        ("TMAX = 1 | irule 14 | drun", WHITE, [(488, "error")]),
        ("TMAX = 1 | irule 2 | drun", WHITE, []),
        ("TMAX = 1 | irule 14 | drun", DELAY, []),
        ("TMAX = 1 | irule 17 | drun", DELAY, [(540, "error")]),
        ("ARRAY F[2, 2], G[2], H[2] | irule 17 | drun", TABLES, [(540, "error")]),
        ("TMAX = 1 | irule 17 | drun", NOISE, [(489, "error")]),
        ("TMAX = 1 | irule 17 | drun", SMOOTH, []),
        ("ARRAY F[2, 2], G[2], H[2] | irule 4 | drun", TABLES, []),
        (
            "ARRAY F[2, 2], G[2], H[2] | irule 17 | drun | irule 4 | drun",
            TABLES,
            [],
        ),  # which of them is not told
    ],
)
def test_check(script, body, problems):
    assert found(script, body) == problems
