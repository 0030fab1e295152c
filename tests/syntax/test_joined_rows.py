"""`_` joins rows anywhere, inside any token: the tree stays, and places point into the real rows."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from desire_tui.engine.diagnostics import render_all
from desire_tui.engine.nodes.walk import walk
from desire_tui.engine.source import Source, Span
from desire_tui.engine.syntax.highlighting import highlight
from desire_tui.engine.syntax.parse import parse, parse_command
from desire_tui.engine.syntax.statement_rows import before, whole
from tests.strategies import programs
from tests.syntax.format.program import format_program
from tests.syntax.format.statements import format_statement

if TYPE_CHECKING:
    from desire_tui.engine.nodes.record import Node

JOINT = re.compile(r"_[ \t\r]*\n")
JOINED = {
    "al_\npha = 1": ["alpha = 1"],
    "fo_\nr i = 1 t_\no 3 s_\ntep 2 | ne_\nxt": ["for i = 1 to 3 step 2", "next"],
    "go_\n to a | end_\n while | g_\no to b": ["go to a", "end while", "go to b"],
    "x = 1_\n2.5_\ne_\n-_\n3": ["x = 0.0125"],
    "x = &&F_\nF": ["x = 255"],
    "write 'one_\ntwo'": ["write 'onetwo'"],
    "write 'a -- b_\n  c', x": ["write 'a -- b  c', x"],
    "write \u2018it_\ns\u2019": ["write 'its'"],
    "write 'a+_\nb -_\n c ='\nx = 2": ["write 'a+b - c ='", "x = 2"],
    "sh echo a_\nb": ["sh 'echo ab'"],
    "x = a__\nb": ["x = a_b"],
    "x = a_  \r\nb\r\ny = 1": ["x = ab", "y = 1"],
    "y = W[1_\n,_\n\t2]": ["y = W[1, 2]"],
    "x = a -- why_\nb = 1": ["x = a", "b = 1"],
    "i_\nf x <_\n= 3 t_\nhen y = 1 | pro_\nceed": ["if x <= 3 then", "y = 1", "proceed"],
    "x = a + _\n-- between\nb": ["x = a + b"],
    "x = a *\nb_\nc": ["x = a * bc"],
    "d_\nrun *\nSHO_\nW *\nx = 1": ["drun *", "SHOW *", "x = 1"],
    "sh echo a_\nb +\nx = 1": ["sh 'echo ab +'", "x = 1"],
    "x = 1 -_\n- all +\ny = 2": ["x = 1", "y = 2"],
}


@pytest.mark.parametrize("text", JOINED)
def test_rows_are_joined_without_a_break(text: str) -> None:
    placed, problems = parse_command(Source(text))
    assert not problems, render_all(problems)
    assert [format_statement(p.node) for p in placed] == JOINED[text]


@settings(deadline=None, max_examples=60)
@given(programs(), st.data())
def test_a_program_broken_anywhere_is_the_same_program(program, data) -> None:
    text = format_program(program)
    ends = st.sampled_from(["_\n", "_ \t\n", "_\r\n"])
    places = sorted(data.draw(st.sets(st.integers(1, max(1, len(text) - 1)), max_size=12)))
    pieces, last = [], 0
    for at in places:
        row = text[text.rfind("\n", 0, at) + 1 : at]
        if row and not text[at : at + 1].isspace() and not row.isspace():
            pieces += [text[last:at], data.draw(ends)]
            last = at
    broken = "".join([*pieces, text[last:]])
    one, other = parse(Source(text)), parse(Source(broken))
    assert not other.problems, render_all(other.problems)
    assert [p.node for p in one.script] == [p.node for p in other.script]
    assert [[p.node for p in s.body] for s in one.segments] == [
        [p.node for p in s.body] for s in other.segments
    ]
    for mine, its in zip(one.script, other.script, strict=True):
        places_now = zip(_spans(mine.node, mine.at), _spans(its.node, its.at), strict=True)
        for before_break, after_break in places_now:
            assert text[slice(*before_break)] == JOINT.sub("", broken[slice(*after_break)])


def _spans(node: Node, at: int) -> list[Span]:
    return [Span(at + part.start, at + part.end) for part in walk(node)]


@pytest.mark.parametrize(
    ("text", "row", "column", "shown"),
    [
        ("x = 1\ny = 2 +_\n  * 3", 3, 3, "*"),
        ("wri_\nte 'a' b", 2, 8, "b"),
        ("x = al_\npha be_\nta", 2, 5, "be_\nta"),
        ("write 'a_\nb' 'c", 2, 4, "'c"),
        ("x = 1.2_\n.3_\n.4", 1, 5, "1.2_\n.3_\n.4"),
        ("fu_\nnny x", 1, 1, "fu_\nnny"),
    ],
)
def test_a_problem_points_into_its_row(text: str, row: int, column: int, shown: str) -> None:
    source = Source(text)
    problem = parse(source).problems[0]
    assert problem.span is not None
    assert source.position(problem.span.start) == (row, column)
    assert text[slice(*problem.span)] == shown


def test_names_are_found_where_they_are_joined() -> None:
    source = Source("store X = al_\npha")
    assert source.name_within(Span(0, len(source.text)), "alpha") == Span(10, len(source.text))
    assert source.word(0) == "store"
    assert Source("wr_ \nite x").word(0) == "write"


def test_an_editor_sees_whole_statements() -> None:
    lines = ["for i = 1 to 3", "write 'a + _", "next'", "  ne_", "  xt", "y = al_", "pha", "next"]
    assert [before(lines, row).count("\n") for row in range(8)] == [0, 0, 1, 0, 1, 0, 1, 0]
    assert whole(lines, 1) == "write 'a + _\nnext'"
    assert whole(lines, 2) == ""
    text = before(lines, 2) + lines[2]
    assert [kind for _, end, kind in highlight(text) if end > len(lines[1])] == ["string"]


def test_many_rows_take_time_in_proportion() -> None:
    rows = 4000
    text = "data " + "".join(f"{i},_\n" for i in range(rows)) + "0"
    program = parse(Source(text))
    assert not program.problems
    assert len(program.script[0].node.items) == rows + 1
