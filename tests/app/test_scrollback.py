"""Output broken into rows."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from desire_tui.panes.scrollback import LINES_MAX, Scrollback

text = st.text(alphabet="ab \n", max_size=80)


@given(st.lists(text, max_size=8), st.integers(10, 30))
def test_rows_hold_every_character_once_in_order_and_fit(pieces: list[str], width: int):
    lines = Scrollback()
    lines.set_width(width)
    for piece in pieces:
        if piece:
            lines.write(piece, "output")
    joined = "".join(pieces)
    expected = joined.split("\n")
    if expected[-1] == "":
        expected.pop()
    assert [line.text for line in lines.lines] == expected
    for number, line in enumerate(lines.lines):
        rows = [row for row in lines.rows if row.line == number]
        assert "".join(line.text[row.start : row.end] for row in rows) == line.text
        assert all(row.end - row.start <= width + 1 for row in rows)


@given(st.lists(text, max_size=6), st.integers(10, 30))
def test_however_it_came_it_is_laid_out_alike(pieces: list[str], width: int):
    grown, whole = Scrollback(), Scrollback()
    grown.set_width(width)
    for piece in pieces:
        if piece:
            grown.write(piece, "output")
    if "".join(pieces):
        whole.write("".join(pieces), "output")
    whole.set_width(width)
    assert grown.rows == whole.rows


def test_the_oldest_lines_go():
    lines = Scrollback()
    lines.add("\n".join(str(n) for n in range(LINES_MAX + 5)), "output", None)
    assert len(lines.lines) == LINES_MAX
    assert lines.lines[0].text == "5"
    assert len(lines.rows) == LINES_MAX


def test_searching_goes_around_the_end():
    lines = Scrollback()
    lines.add("one\ntwo\nThree\ntwo", "output", None)
    assert lines.find("TWO", 4, -1) == 3
    assert lines.find("two", 3, -1) == 1
    assert lines.find("two", 1, -1) == 3
    assert lines.find("three", 3, 1) == 2
    assert lines.find("four", 0, 1) is None
