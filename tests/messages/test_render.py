"""The drawing of a message: place, frame, carets, notes (whole messages: the golden files)."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from desire_tui.engine.diagnostics import Diagnostic, render, render_all
from desire_tui.engine.diagnostics.render import COLUMNS_MAX, _width
from desire_tui.engine.source import Source, Span

KEY = "statement-end"


def frame(text: str, start: int, end: int) -> list[str]:
    return render(Diagnostic(KEY, Span(start, end), {"text": "b"}, Source(text, "f"))).split("\n")[1:3]


def test_no_source_and_no_place() -> None:
    assert render(Diagnostic(KEY, None, {"text": "b"})).startswith(
        "error 33: the statement should end before 'b'\n"
    )
    assert render(Diagnostic(KEY, None, {"text": "b"}, Source("", "f.src"))).startswith("f.src: error 33: ")


def test_warning() -> None:
    assert render(Diagnostic(KEY, severity="warning")).startswith("warning 33: ")


@pytest.mark.parametrize(
    ("text", "start", "end", "wanted"),
    [
        ("abc def", 4, 7, ["    abc def", "        ^^^"]),
        ("abc\ndef\n", 4, 7, ["    def", "    ^^^"]),
        ("abc", 3, 4, ["    abc", "       ^"]),
        ("", 0, 0, ["    ", "    ^"]),
        ("ab\ncd", 1, 5, ["    ab", "     ^"]),
        ("a\tb", 2, 3, ["    a   b", "        ^"]),
        ("日本 x", 3, 4, ["    日本 x", "         ^"]),
        ("e\u0301x", 2, 3, ["    e\u0301x", "     ^"]),
        ("a\x1b[31mb", 6, 7, ["    a␛[31mb", "          ^"]),
        ("abc\r\n", 0, 3, ["    abc", "    ^^^"]),
    ],
)
def test_frame(text: str, start: int, end: int, wanted: list[str]) -> None:
    assert [line.rstrip() for line in frame(text, start, end)] == [line.rstrip() for line in wanted]


@given(st.text(max_size=400), st.integers(0, 400), st.integers(0, 400))
def test_any_span_fits_the_width_and_carets_stand_below_the_line(text: str, start: int, length: int) -> None:
    start = min(start, len(text))
    lines = frame(text, start, start + length)
    assert len(lines) == 2
    assert all(_width(line) <= COLUMNS_MAX + 8 for line in lines)
    assert set(lines[1]) <= {" ", "^"}
    assert "^" in lines[1]


@given(st.integers(0, 3000), st.integers(1, 30))
def test_the_carets_mark_the_span_in_a_long_line(start: int, length: int) -> None:
    text = "".join(chr(ord("a") + i % 26) for i in range(3030))
    line, carets = frame(text, start, start + length)
    at = carets.index("^")
    assert line[at : at + carets.count("^")] == text[start : start + length]


def test_several() -> None:
    one = Diagnostic(KEY, None, {"text": "b"})
    assert render_all([one, one]) == f"{render(one)}\n\n{render(one)}"
    assert render_all([]) == ""
