"""Words, names and brackets of a line, told apart as the parser does."""

from __future__ import annotations

import pytest

from desire_tui.language.line_tokens import (
    brackets_in,
    first_word,
    joined_word_at,
    listed_names,
    word_at,
    words_in,
)


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("x = sin(y)", ["x", "sin", "y"]),
        ("write 'a--b'; c -- d", ["write", "c"]),
        ('write "it\'s"; c', ["write", "c"]),
        ("10 a$ = b_c | end while", ["a$", "b_c", "end", "while"]),
        ("d/dt x = 1E3*v", ["d/dt", "x", "v"]),
        ("keep 'file'", ["keep"]),
        ("input = 3 | data[2] = input", ["input", "data", "input"]),
    ],
)
def test_words(line: str, words: list[str]):
    assert words_in(line) == words


@pytest.mark.parametrize(
    ("line", "column", "word"),
    [
        ("x = sigma/tau", 7, "sigma"), ("x = sigma/tau", 9, "sigma"), ("x = sigma/tau", 10, "tau"),
        ("d/dt x = v", 2, "d/dt"), ("Vectr d/dt x = v", 7, "d/dt"), ("y = d/dt", 4, "d"), ("write 'see dispt'", 12, "dispt"),
        ("-- see dispt", 9, "dispt"), ("help 200", 6, "200"), ("x$i = 1", 1, "x$i"), ("a = (b)", 4, ""), ("", 0, ""),
        ("if a then", 6, "then"), ("end while", 5, "while"),
    ],
)  # fmt: skip
def test_the_word_under_the_cursor(line: str, column: int, word: str):
    assert word_at(line, column) == word


def test_the_word_under_the_cursor_may_go_over_rows():
    lines = ["x = al_", "pha + be_", "  ta", "y = 'al_", "pha'"]
    at = [(0, 4), (0, 6), (1, 0), (1, 2), (1, 6), (2, 3), (4, 1)]
    found = [joined_word_at(lines, row, column) for row, column in at]
    assert found == ["alpha", "alpha", "alpha", "alpha", "be", "ta", "pha"]


@pytest.mark.parametrize(
    ("line", "names"),
    [
        ("x", ["x"]), (" x, y ; z$ ", ["x", "y", "z$"]), ("x, y -- both", ["x", "y"]), ("input", ["input"]), ("x y", []),
        ("x,", []), ("x | y", []), ("x = 1", []), ("write x", []), ("1, x", []), ("'x'", []), ("", []),
    ],
)  # fmt: skip
def test_a_line_of_names(line: str, names: list[str]):
    assert listed_names(line) == names


def test_brackets_of_comments_and_strings_do_not_count():
    assert brackets_in("10 f('(', a[1]) -- )") == ((4, "("), (11, "["), (13, "]"), (14, ")"))


@pytest.mark.parametrize(
    ("line", "word"),
    [("dispt x, v", "dispt"), ("write'x'", "write"), ("3 + x", ""), ("-- x", ""), ("end while", "end while")],
)
def test_the_first_word(line: str, word: str):
    assert first_word(line) == word
