"""Lines read by a pattern mean what the tokenizer says they mean, with the same offsets."""

from __future__ import annotations

import re
from pathlib import Path
from unittest.mock import patch

import pytest
from hypothesis import given
from hypothesis import strategies as st

from desire_tui.engine.nodes.record import Node
from desire_tui.engine.source import Source
from desire_tui.engine.syntax import line_patterns, shapes
from desire_tui.engine.syntax.parse import parse
from desire_tui.engine.syntax.parsed_lines import forget_lines

ROOT = Path(__file__).parents[2]
PROGRAMS = sorted(p for folder in ("examples", "tests/programs") for p in (ROOT / folder).rglob("*.src"))
WORD = re.compile(r"(?<![A-Za-z0-9$_.])[A-Za-z][A-Za-z0-9$_]*|(?<![A-Za-z0-9$_.])[0-9]+\.?[0-9]*")
ODD = [
    "q/dt x = a", "d/dt x = a", "d/dt  x = a", " d/dt x = a", "d/dt x = a -- b", "x = a and b", "x = a or -b",
    "and = a", "x = 1e5", "x = 1e400", "x = 1e400 - y", "x = 12345", "if = 3", "to = 3", "step = a", "term = a",
    "x = 2y", "x = .5", "x = y.z", "x = 'a'", "x = a | y = b", "x = a_", "x = a +", "x = _a", "x\t=\ta\r",
    "x = \x01", "\x01 = a b", "x = a\x1a", "x = \N{MINUS SIGN}a", "x = a\N{NO-BREAK SPACE}b", "time = a", "x = &10", "x = &a",
    "x_1 = a_b*c_d", "A[i] = B[j, k]", "x = sin(cos(a))", "x' = a", "d = a/dt", "d/dt = a", "5 = a", "x = (a", "x = a b",
    "x = not a", "(a, b) = c", "d/dt x[3] = a*(b - c[2])", "x = a<b", "x=a*-b",
]  # fmt: skip


def shown(part: object) -> object:
    """A node with its offsets, which `==` does not look at."""
    if isinstance(part, Node):
        return type(part).__name__, *(shown(getattr(part, name)) for name in part.__slots__)
    if isinstance(part, tuple):
        return tuple(shown(item) for item in part)
    return part


def meaning(text: str) -> object:
    program = parse(Source(text))
    found = [*program.script, *(placed for segment in program.segments for placed in segment.body)]
    problems = [(p.key, p.span, p.facts) for p in program.problems]
    return [(placed.at, placed.number, shown(placed.node)) for placed in found], problems


@pytest.fixture
def unlearned(monkeypatch):
    """Parse without patterns."""

    def plain(text: str) -> object:
        forget_lines()
        with monkeypatch.context() as patch:
            patch.setattr(line_patterns, "read", lambda line: None)
            return meaning(text)

    return plain


def other_words(text: str, longer: str) -> str:
    """The text with other numbers, and other names where a name is no word of the language."""
    keep = {"d", "dt", *line_patterns.KEYWORDS, "and", "or", "not", "then", "to", "as", "sin", "cos", "exp"}
    return WORD.sub(lambda f: f[0] if f[0] in keep else f[0] + (longer if f[0][0].isalpha() else "7"), text)


def test_programs_with_other_names(unlearned):
    """A twelfth of all programs: the others passed once, and take 16 s."""
    read = 0
    for path in PROGRAMS[::12]:
        text = path.read_text()
        rows = [row for row in text.split("\n") if len(row) < 300]
        more = "\n".join(
            [
                *rows,
                *rows,
                *(other_words(row, "q") for row in rows),
                *(other_words(row, "_2x") for row in rows),
            ]
        )
        expected = unlearned(more)
        forget_lines()
        assert meaning(more) == expected, path
        read += sum(line_patterns.read(row) is not None for row in rows)
    assert read > 20, "or no pattern was at work"


@pytest.mark.parametrize("line", ODD)
def test_odd_lines(line, unlearned):
    before = "\n".join(
        f"{kind.replace('a', name)}"
        for kind in ODD
        for name in ("a", "u1", "w27", "f", "g", "b", "e", "c")
        if kind != line
    )
    text = before + "\n" + line
    expected = unlearned(text)
    forget_lines()
    assert meaning(text) == expected


@pytest.mark.parametrize(
    "lines",
    [
        ["x = 2e5*a", "x = 2b5*a", "x = 2E5*a", "x = 2B5*a"],
        ["d/dt x = a*b", "q/dt x = a*b", "d/dt c = a*b", "d/ds x = a*b", "b/dt x = a*b"],
        ["a = 2*x", "d = 2*x", "go = 2*x", "to = 2*x", "if = 2*x", "ab = 2*x"],
        ["x = 1.5", "x = 1_5", "x = a.5", "x = a_5", "x = a$5", "x = 1$5"],
    ],
)
def test_lines_of_one_layout(lines, unlearned):
    """Each is read after many that have letters and digits at the same places."""
    text = "\n".join(
        line for one in lines for line in [*[one.replace("x", name) for name in "pqrstu"], *lines]
    )
    expected = unlearned(text)
    forget_lines()
    assert meaning(text) == expected


def test_a_line_is_learned_whose_shape_is_older_than_other_programs():
    text = "d/dt x0 = a*(y0 - x0)"
    parse(Source(text + "\n" + text.replace("0", "1")))
    shapes._patterns.forget()  # as when many other shapes came since; what it made is still in use
    forget_lines()
    test_the_place_of_words_is_known_from_lines_before()


def test_the_place_of_words_is_known_from_lines_before():
    parse(Source("\n".join(f"d/dt x{i} = a*(y{i} - x{i})" for i in range(10, 20))))
    with patch.object(line_patterns, "_skeleton", side_effect=AssertionError):
        assert line_patterns.read("d/dt y77 = b*(z77 - y77)") is not None
        with pytest.raises(AssertionError):
            line_patterns.read("d/dt y777 = b*(z77 - y77)")


def test_a_line_that_is_too_long_looks_like_none(unlearned):
    text = "\n".join(["x = a", "x = bb", "x = " + "y" * 1_000_001])
    expected = unlearned(text)
    forget_lines()
    found = meaning(text)
    assert found == expected
    assert [key for key, _, _ in found[1]] == ["line-too-long"]


@given(
    st.lists(
        st.sampled_from(
            [
                "a",
                "x12",
                "d",
                "dt",
                "7",
                "0.25",
                "1e400",
                "and",
                "step",
                "+",
                "-",
                "*",
                "/",
                "=",
                "(",
                ")",
                " ",
                "d/dt ",
                "_",
                "[",
                "]",
            ]
        ),
        max_size=12,
    ),
    st.integers(1, 3),
)
def test_random_lines(parts, times):
    line = "".join(parts)
    learned = [
        "x = a*(b - c)",
        "y = b*(c - d)",
        "z = 2*(c - d)",
        "d/dt x = a - b",
        "d/dt yy = bb - aa",
        "d/dt z = c - x",
    ]
    text = "\n".join([*learned, *[line.replace("x12", "y" * k) for k in range(1, times + 1)], line])
    forget_lines()
    found = meaning(text)
    read = line_patterns.read
    forget_lines()
    line_patterns.read = lambda line: None
    try:
        assert meaning(text) == found
    finally:
        line_patterns.read = read
