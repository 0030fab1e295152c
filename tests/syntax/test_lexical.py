"""Lexical rules (language.md 2): continuation, comments, numbered files, pasted text, highlighting."""

from __future__ import annotations

import pytest

from desire_tui.engine.nodes.assignments import Assign
from desire_tui.engine.nodes.expressions import Binary, Name, Number, Text
from desire_tui.engine.source import Source
from desire_tui.engine.syntax.highlighting import highlight
from desire_tui.engine.syntax.parse import parse, parse_command
from desire_tui.engine.syntax.statement_rows import before
from tests.syntax.format.statements import format_statement

JOINED = {
    "x = a + _\n3": ["x = a + 3"],
    "x = a _\n + 3": ["x = a + 3"],
    "x = a_\n": ["x = a"],
    "x = a +\n3": ["x = a + 3"],
    "x = a *\n3": ["x = a * 3"],
    "x = a /\n3": ["x = a / 3"],
    "x = a ^\n3": ["x = a^3"],
    "x =\n3": ["x = 3"],
    "x = a -\n3": ["x = a - 3"],
    "x = a +   \r\n3\r\n": ["x = a + 3"],
    "x = a + -- why\n3": ["x = a + 3"],
    "x = a +\n-- why\n3 | y = 4": ["x = a + 3", "y = 4"],
    "x = a +\nb +\nc\ny = 1": ["x = a + b + c", "y = 1"],
    "x = 1 | y = _\n2 | z = 3": ["x = 1", "y = 2", "z = 3"],
}
APART = {
    "write x;\ny = 3": ["write x;", "y = 3"],
    "write x,\ny = 3": ["write x,", "y = 3"],
    "tdelay y = D(x, a\nz = 3": ["tdelay y = D(x, a)", "z = 3"],
    "x = 1 -- +\ny = 3": ["x = 1", "y = 3"],
    "-- ======\ny = 3": ["y = 3"],
    "-- a_\ny = 3": ["y = 3"],
    "write '+'\ny = 3": ["write '+'", "y = 3"],
    "x = 1 --\ny = 3": ["x = 1", "y = 3"],
    "drun *\ny = 3": ["drun *", "y = 3"],
    "drunr *\nfor i = 0 to _\n3": ["drunr *", "for i = 0 to 3"],
    "SHOW *\nfor i = 0 to +\n3": ["SHOW *", "for i = 0 to +3"],
    "list+\ny = 3": ["list+", "y = 3"],
    "x = 3 _ \n\ny = 3": ["x = 3", "y = 3"],
}


@pytest.mark.parametrize("text", [*JOINED, *APART])
def test_continuation(text: str) -> None:
    program = parse(Source(text))
    assert not [problem for problem in program.problems if problem.severity == "error"]
    assert [format_statement(p.node) for p in program.script] == {**JOINED, **APART}[text]


def test_names_may_hold_underscores_and_any_length() -> None:
    name = "a_long_name_of_more_than_twenty_characters$1"
    program = parse(Source(f"{name} = 3 | y = {name}"))
    assert [p.node.target.name for p in program.script] == [name, "y"]


def test_case_matters() -> None:
    program = parse(Source("SAT = 1 | sat = 2 | x = SAT"))
    assert [p.node.target.name for p in program.script] == ["SAT", "sat", "x"]


def test_numbered_file_with_header_lines() -> None:
    text = "/NEW\nPIC 'step'\n/\n100 -- comment\n110 x = 1 | y = 2\n120\n 130 go to 110\n/\n"
    program = parse(Source(text))
    assert not program.problems
    assert [(format_statement(p.node), p.number) for p in program.script] == [
        ("x = 1", 110),
        ("y = 2", 110),
        ("go to 110", 130),
    ]
    assert text[program.script[1].at :].startswith("y = 2")


def test_windows_line_ends_keep_offsets() -> None:
    text = "x = 1\r\ny = 2 \r\n"
    program = parse(Source(text))
    assert [text[slice(*p.span())] for p in program.script] == ["x = 1", "y = 2"]


def test_pasted_characters_count_as_ascii_outside_of_strings() -> None:
    text = "x\u00a0= 3 – 4 − 5\nwrite ‘it’, “a – b”, 'it’s – so', \"“\""
    program = parse(Source(text))
    assert not program.problems
    first, second = (p.node for p in program.script)
    assert first == Assign(Name("x"), Binary("-", Binary("-", Number(3.0), Number(4.0)), Number(5.0)))
    assert [item.value for item in second.items] == [Text("it"), Text("a – b"), Text("it’s – so"), Text("“")]
    assert text[slice(*program.script[1].span(second.items[2]))] == "'it’s – so'"


def test_segments() -> None:
    text = "drun | drun two\nDYNAMIC\nd/dt x = -x\nlabel two\nd/dt y = -y\nJACOBIAN\nJ[1,1] = -1\nSTOP\nthe end's near"
    program = parse(Source(text))
    assert not program.problems
    assert [format_statement(p.node) for p in program.script] == ["drun", "drun two"]
    plain, two = program.segments
    assert (plain.label, [format_statement(p.node) for p in plain.body]) == (None, ["d/dt x = -x"])
    assert (two.label, [format_statement(p.node) for p in two.body]) == ("two", ["d/dt y = -y"])
    assert [format_statement(p.node) for p in two.jacobian] == ["J[1, 1] = -1"]
    assert text[two.at :].startswith("label two")


def test_a_segment_ends_at_its_stop_and_the_next_label_begins_another() -> None:
    program = parse(Source("DYNAMIC\nx = 1\nSTOP\ncommentary (\nlabel b\ny = 1\n"))
    assert not program.problems
    assert [(s.label, len(s.body)) for s in program.segments] == [(None, 1), ("b", 1)]


def test_a_program_without_dynamic_part_is_only_a_script() -> None:
    assert parse(Source("x = 1\nSTOP\ny = 2")).segments == ()


def test_a_command_line_has_no_line_numbers() -> None:
    placed, problems = parse_command(Source("3 + 4"))
    assert not problems
    assert format_statement(placed[0].node) == "3 + 4"


HIGHLIGHTED = {
    "210 if sin(t) > TMAX then write 'a' -- c": "210=comment if=keyword sin=function (=operator t=system )=operator "
    ">=operator TMAX=system then=keyword write=keyword 'a'=string -- c=comment",
    "input = input + sin": "input=name ==operator input=name +=operator sin=name",
    "display N14 | FFT F,n,x,y": "display=keyword N=keyword 14=number FFT=keyword F=keyword ,=operator n=name "
    ",=operator x=name ,=operator y=name",
    "d/dt x = &17": "d/dt=keyword x=name ==operator &17=number",
    "Vectr delta x = $In(A)": "Vectr=keyword delta=keyword x=name ==operator $In=function (=operator A=name )=operator",
    "write 'open": "write=keyword 'open=string",
    "sh ls -l": "sh=keyword ls -l=string",
    "end while": "end while=keyword",
    "PIC 'x'": "PIC 'x'=comment",
}


@pytest.mark.parametrize("line", HIGHLIGHTED)
def test_highlighting(line: str) -> None:
    assert " ".join(f"{line[start:end]}={cls}" for start, end, cls in highlight(line)) == HIGHLIGHTED[line]


CONTINUED = """\
x = 1 + _
  step * 2 +
  -- a comment between; step
  input
step 3
y =
for i = 1 to 2
30 z = y *
40 + 1
-- ends in _
next"""


def test_a_row_in_which_a_statement_goes_on_begins_none() -> None:
    lines = CONTINUED.split("\n")
    rows = [before(lines, row).count("\n") for row in range(len(lines))]
    assert rows == [0, 1, 2, 3, 0, 0, 0, 0, 1, 0, 0]  # `y =` only seems to go on

    def classes(row: int) -> dict[str, str]:
        text = before(lines, row)
        whole = text + lines[row]
        return {whole[a:b]: name for a, b, name in highlight(whole) if a >= len(text)}

    assert classes(1)["step"] == classes(3)["input"] == "name"
    assert classes(2) == {"-- a comment between; step": "comment"}
    assert classes(4)["step"] == classes(6)["for"] == classes(10)["next"] == "keyword"
    assert classes(8)["40"] == "number"
    assert before(["x = _"] * 300, 250).count("\n") == 100  # no key waits for a statement without end


@pytest.mark.parametrize("word", ["else", "proceed"])
def test_a_strange_character_alone_before_else(word):
    """One message, about the character; the block is whole."""
    program = parse(Source(f"if x = 1 then é {word}\nx = 2\nproceed"))
    assert [problem.key for problem in program.problems] == ["strange-character"]


def test_carriage_returns_end_lines():
    """`\\n`, `\\r\\n` and `\\r` alone, mixed; rows and columns count them alike."""
    source = Source("x = 1\ry = 2 -- a\r\nwrite x\n\r z = )")
    program = parse(source)
    assert [placed.at for placed in program.script] == [0, 6, 18, 28]  # the last one is faulty
    (problem,) = program.problems
    assert source.position(problem.span.start) == (5, 6)
    assert source.line(2) == "y = 2 -- a"
