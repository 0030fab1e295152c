"""Which quantities of a program are worth varying, and how values are written into its text."""

from __future__ import annotations

import pytest

from desire_tui.engine.session.parameters import parameters, written_into
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source
from desire_tui.engine.syntax.parse import parse

MODEL = """\
-- a model
TMAX = 1 | DT = 0.1 | NN = 3
a = 2 | b = -3
STATE y[2] | ARRAY q[3], big[40]
q[2] = 5
c = a + 1
for k = 1 to 2
  r = 10*k
  drunr
next
DYNAMIC
d/dt x = c - r*x + b*q[2] + big[3]
Vectr d/dt y = -x*y
s = x
dispt x
"""


def test_parameters_of_a_model():
    session = Session(backend="reference")
    session.erun(Source(MODEL))
    found = parameters(session.program, session.values, session.runs[-1].start)
    assert [(one.label, one.value, one.kind) for one in found] == [
        ("a", 2.0, "number"), ("b", -3.0, "number"), ("q[2]", 5.0, "number"),
        ("c", 3.0, "computed"), ("r", 20.0, "computed"),
        ("x(0)", 0.0, "initial"), ("y[1](0)", 0.0, "initial"), ("y[2](0)", 0.0, "initial"),
    ]  # fmt: skip


def changed(text, **values):
    written = written_into(
        parse(Source(text)), {name.replace("_", "["): value for name, value in values.items()}
    )
    for span, new in written.edits:
        text = text[: span.start] + new + text[span.end :]
    return text, written.refused


@pytest.mark.parametrize(
    ("values", "old", "new"),
    [
        ({"a": 0.25}, "a = 2 |", "a = 0.25 |"),
        ({"b": 4.0, "a": -1e-7}, "a = 2 | b = -3", "a = -1e-07 | b = 4"),
        ({"c": 1.5}, "c = a + 1", "c = 1.5"),
        ({"x": 0.5, "a": 9}, "a = 2 | b = -3\nSTATE y[2] | ARRAY q[3], big[40]\n", "a = 9 | b = -3\nSTATE y[2] | ARRAY q[3], big[40]\nx = 0.5\n"),
    ],
)  # fmt: skip
def test_values_are_written_where_the_program_gives_them(values, old, new):
    assert changed(MODEL, **values) == (MODEL.replace(old, new), [])


def test_what_is_given_in_several_places_is_left_alone():
    text = "a = 1\na = 2\nread b\nfor c = 1 to 2\ndrun\nnext\nDYNAMIC\nx = a + b + c\ndispt x\n"
    assert changed(text, a=3, b=4, c=5) == (text, ["a", "b", "c"])
    assert changed("drun\nDYNAMIC\nd/dt x = 1\ndispt x\n", x=2) == (
        "x = 2\ndrun\nDYNAMIC\nd/dt x = 1\ndispt x\n",
        [],
    )
