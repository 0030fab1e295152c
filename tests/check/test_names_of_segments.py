"""What a segment may name, as a look at the script tells: which assignments, sizes and constants count."""

from __future__ import annotations

import pytest

from desire_tui.engine.check.checker import check
from desire_tui.engine.source import Source
from desire_tui.engine.syntax.parse import parse


def codes(text):
    return [problem.code for problem in check(parse(Source(text, "t.src")))]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        # a name that only its own segment sets, further down, is used too early
        ("TMAX = 1 | drun\nDYNAMIC\nd/dt x = y\ny = x\n", [200]),
        # … one that another segment sets may be there already
        ("TMAX = 1 | drun | drun B\nDYNAMIC\nd/dt x = y\nlabel B\nd/dt z = 1\ny = z\n", []),
        # the first drun of a segment decides, not the last
        ("TMAX = 1 | drun | a = 1 | drun\nDYNAMIC\nd/dt x = a\n", [200]),
        ("TMAX = 1 | a = 1 | drun | drun\nDYNAMIC\nd/dt x = a\n", []),
        # a submodel's dummies are no names of the program
        ("TMAX = 1\nSUBMODEL s(p$)\np$ = 1\nend\ndrun\nDYNAMIC\ns(a)\nd/dt x = p$ + a\n", [200]),
        ("SUBMODEL s(p$)\np$ = 1\nend\nTMAX = 1 | drun\ny = p$\nDYNAMIC\ns(a)\nd/dt x = a\n", [200]),
        # a size that is assigned twice may be either
        ("n = 2 | n = 3 | ARRAY v[n], w[3]\nTMAX = 1 | drun\nDYNAMIC\nVector w = v\nd/dt x = 1\n", []),
        ("n = 2 | ARRAY v[n], w[3]\nTMAX = 1 | drun\nDYNAMIC\nVector w = v\nd/dt x = 1\n", [74]),
        # arrays come into a procedure by value and by reference
        ("ARRAY v[2]\nPROCEDURE p(a$; b$)\nb$[1] = a$[2]\nend\ncall p(v; v)\nwrite v[1]\n", []),
        # commands at a STOP may define a FUNCTION anew
        ("FUNCTION f(a$) = a$\nSTOP\nx = f(1, 2)\n", []),
        ("FUNCTION f(a$) = a$\nx = f(1, 2)\n", [56]),
    ],
)
def test_problems(text, expected):
    assert codes(text) == expected
