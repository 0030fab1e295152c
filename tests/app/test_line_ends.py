"""Each line keeps the end that it has in its file, whatever is done to the others."""

from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from desire_tui.editor.buffer import Buffer, NotText
from desire_tui.editor.line_ends import ended, ends_of, following, usual
from desire_tui.editor.program_lines import ProgramLines
from desire_tui.engine.text_encoding import encode

TEXTS = st.lists(st.sampled_from(["a", "b", "", "\n", "\r\n", "\r", "x = 1", "\x0b"])).map("".join)
"""Lines of every kind, most of them like others."""


def pieces(text):
    """Return the lines with their ends."""
    return re.findall(r"[^\r\n]*(?:\r\n|\r|\n)|[^\r\n]+\Z", text)


def place(lines, draw):
    row = draw(st.integers(0, lines.line_count - 1))
    return row, draw(st.integers(0, len(lines.lines[row])))


@given(data=st.binary() | TEXTS.map(str.encode))
def test_a_file_that_is_saved_unchanged_has_the_same_bytes(tmp_path_factory, data):
    path = tmp_path_factory.mktemp("files") / "a.src"
    path.write_bytes(data)
    try:
        buffer = Buffer.from_file(path)
    except NotText:
        assert b"\0" in data
        return
    lines = ProgramLines(buffer.ended_text)
    assert lines.text == buffer.saved_text
    assert encode(lines.ended_text, buffer.encoding) == data


@given(TEXTS, st.data())
def test_what_is_typed_into_a_line_changes_no_other_byte(text, data):
    lines = ProgramLines(text)
    row, column = place(lines, data.draw)
    before = pieces(lines.ended_text)
    lines.replace_range((row, 0), (row, column), "typed")
    after = pieces(lines.ended_text)
    assert after[:row] == before[:row]
    assert after[row + 1 :] == before[row + 1 :]


@given(TEXTS, st.data())
def test_a_line_that_is_split_and_joined_again_is_as_before(text, data):
    lines = ProgramLines(text)
    at = place(lines, data.draw)
    before = lines.ends.copy()
    end = lines.replace_range(at, at, "\n").end_location
    lines.replace_range(at, end, "")
    assert lines.ends == before


@given(TEXTS, st.data())
def test_undo_and_redo_put_every_end_back(text, data):
    lines = ProgramLines(text)
    states, edits = [lines.ended_text], []
    for _ in range(data.draw(st.integers(1, 6))):
        start, end = sorted((place(lines, data.draw), place(lines, data.draw)))
        new = data.draw(TEXTS)
        edits.append((start, end, new, lines.replace_range(start, end, new)))
        assert len(lines.ends) == lines.line_count
        assert [bool(each) for each in lines.ends] == [True] * (lines.line_count - 1) + [False]
        states.append(lines.ended_text)
    for state, (start, _, _, result) in zip(states[-2::-1], edits[::-1], strict=True):
        lines.replace_range(start, result.end_location, result.replaced_text)
        assert lines.ended_text == state
    for state, (start, end, new, _) in zip(states[1:], edits, strict=True):
        lines.replace_range(start, end, new)
        assert lines.ended_text == state


@given(TEXTS, st.data())
def test_lines_outside_a_change_keep_their_ends(text, data):
    lines = ProgramLines(text)
    start, end = sorted((place(lines, data.draw), place(lines, data.draw)))
    before = lines.ends.copy()
    lines.replace_range(start, end, data.draw(TEXTS))
    assert lines.ends[: start[0]] == before[: start[0]]
    below = len(before) - end[0] - 1
    assert below == 0 or lines.ends[-below:] == before[-below:]


@given(TEXTS, TEXTS, st.data())
def test_what_is_written_is_read_as_the_same_lines(one, other, data):
    lines = ProgramLines(one)
    lines.replace_range(*sorted((place(lines, data.draw), place(lines, data.draw))), other)
    assert ProgramLines(lines.ended_text).lines == lines.lines


@pytest.mark.parametrize(
    ("text", "start", "end", "new", "becomes"),
    [
        ("a\r\nb\r\nc\n", (0, 1), (0, 1), "\n", "a\r\n\r\nb\r\nc\n"),
        ("a\r\nb\nc\n", (0, 1), (0, 1), "\nx", "a\r\nx\nb\nc\n"),  # the line keeps its own
        ("ab\r\nb\nc\n", (0, 1), (0, 1), "\n", "a\nb\r\nb\nc\n"),
        ("a\r\nb\nc\n", (0, 1), (1, 0), "", "ab\nc\n"),
        ("a\r\nb\nc\n", (0, 0), (1, 0), "", "b\nc\n"),
        ("a\r\nb\nc", (0, 1), (2, 1), "", "a"),
        ("a\r\nb\r\nc", (2, 1), (2, 1), "\n", "a\r\nb\r\nc\r\n"),
        ("a\r\nb\nc\rd\n", (0, 0), (2, 1), "1\n2\n3", "1\r\n2\n3\rd\n"),
        ("a\rb\n", (1, 0), (1, 1), "", "a\r\r\n"),  # `\r` and `\n` would be one end
    ],
)
def test_new_lines_end_as_most_do_and_old_ones_as_they_did(text, start, end, new, becomes):
    lines = ProgramLines(text)
    lines.replace_range(start, end, new)
    assert lines.ended_text == becomes


def test_lines_that_another_program_wrote_keep_the_ends_of_those_they_are():
    old, new = ["a", "b", "c", "d"], ["b", "x", "c", "y", "d"]
    ends = following(old, ["\n", "\r\n", "\r", ""], new, "\n")
    assert ends == ["\r\n", "\n", "\r", "\n", ""]


def test_most_lines_decide_and_line_feeds_where_none_do():
    assert usual(ends_of("a\r\nb\r\nc\n")) == "\r\n"
    assert usual(ends_of("a\r\nb\n")) == "\n"
    assert usual(ends_of("a"), "\r\n") == "\r\n"


@given(TEXTS)
def test_ends_and_lines_make_the_text(text):
    lines = ProgramLines(text).lines
    assert ended(lines, ends_of(text)) == text
    assert not any("\r" in line or "\n" in line for line in lines)
