"""Requests: what is read, and what is said of mistakes."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from desire_tui.analysis.request import Request
from desire_tui.engine.diagnostics import DesireError

EXAMPLE = "k in [0, 5]"


def problem(error):
    (diagnostic,) = error.value.diagnostics
    span = diagnostic.span
    return diagnostic.message, diagnostic.hint, diagnostic.source.text[span.start : span.end]


def test_names_numbers_and_intervals():
    asked = Request("k, A[2] = -1e-3 in [ -5, 2.5 ] over x1*sin(a, b), t -> 'my file.csv'", EXAMPLE)
    assert asked.name() == "k"
    assert asked.take(",")
    assert asked.name() == "A[2]"
    asked.expect("=")
    assert asked.number() == -1e-3
    assert asked.take("in")
    assert asked.interval() == (-5.0, 2.5)
    asked.expect("over")
    assert asked.expression(",") == "x1*sin(a, b)"
    assert asked.take(",")
    assert asked.name() == "t"
    asked.expect("->")
    assert asked.text() == "my file.csv"
    assert asked.is_done
    asked.end()


def test_files_with_and_without_quotes():
    asked = Request("swing.csv, data/run-2.csv,'my file.csv' , c loss huber", EXAMPLE)
    files = [asked.file()]
    while asked.take(","):
        files.append(asked.file())
    assert files == ["swing.csv", "data/run-2.csv", "my file.csv", "c"]
    assert asked.take("loss")
    with pytest.raises(DesireError) as error:
        Request("", EXAMPLE).file()
    assert problem(error)[0] == "the request ends where a file's name is expected"


@pytest.mark.parametrize(
    ("text", "read", "wanted"),
    [
        ("3", lambda r: r.name(), ("'3' stands where a name is expected", "for instance: k in [0, 5]", "3")),
        ("", lambda r: r.number(),
         ("the request ends where a number is expected", "for instance: k in [0, 5]", "")),
        ("[5, 1]", lambda r: r.interval(), ("the interval from 5 to 1 holds nothing", "[1, 5]", "[5, 1]")),
        ("raet", lambda r: r.known("raet", ["k", "rate"], "parameter"),
         ("'raet' is no parameter", "did you mean rate?", "raet")),
        ("k k", lambda r: (r.name(), r.end()),
         ("'k' stands at the end, where nothing is expected", "for instance: k in [0, 5]", "k")),
    ],
)  # fmt: skip
def test_mistakes_are_told_at_their_place(text, read, wanted):
    with pytest.raises(DesireError) as error:
        read(Request(text, EXAMPLE))
    assert problem(error) == wanted


@given(st.text(max_size=40))
def test_any_text_is_read_or_refused(text):
    asked = Request(text, EXAMPLE)
    try:
        while not asked.is_done:
            asked.take(",", "in", "->")
            asked.expression(",")
    except DesireError:
        pass
