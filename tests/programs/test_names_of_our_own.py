"""No name of the language's own breaks a program: it gives way to what the program assigns, declares or defines."""

from __future__ import annotations

import pytest

from desire_tui.engine.library import LIBRARY
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source

SCRIPT = [
    "{n} = 3 | y = {n} + 1",
    "ARRAY {n}[3] | {n}[2] = 3 | y = {n}[2] + 1",
    "FUNCTION {n}(a$) = a$ + 1 | y = {n}(3)",
    "PROCEDURE {n}(;a)\na = 4\nend\ncall {n}(;y)",
    "go to {n} | y = 1\nlabel {n} | y = 4",
]
SEGMENT = [
    "NN = 2 | drun\nDYNAMIC\n{n} = 3\ny = {n} + 1\ntype {n}",
    "SUBMODEL {n}(a$)\na$ = 4\nend\nNN = 2 | drun\nDYNAMIC\n{n}(y)",
    "SUBMODEL {n}(a$)\na$ = 4\nend\nNN = 2 | drun\nDYNAMIC\ninvoke {n}(y)",
    "FUNCTION {n}(a$) = a$ + 1 | NN = 2 | drun\nDYNAMIC\ny = {n}(3)",
]
BEYOND = [
    "max",
    "min",
    "mod",
    "floor",
    "ceil",
    "heav",
    "compare",
    "snapshot",
    "notebook",
    "title",
    "xlabel",
    "ylabel",
    "event",
    "every",
    "white",
    "units",
]


@pytest.mark.parametrize("name", [*LIBRARY, *BEYOND[6:], "ERABS", "auto", "delta", "UPDATE", "SHOW"])
def test_a_script_may_use_the_name(name) -> None:
    for form in SCRIPT:
        assert value_of_y(form.format(n=name)) == 4


@pytest.mark.parametrize("name", [*BEYOND, "ERABS", "delta", "UPDATE"])
def test_a_segment_may_use_the_name(name) -> None:
    for form in SEGMENT:
        assert value_of_y(form.format(n=name)) == 4


def value_of_y(text: str) -> float:
    session = Session()
    session.erun(Source(text, "p"))
    found = session.values.find("y")
    assert found is not None
    return float(session.values.cells[found.slot])
