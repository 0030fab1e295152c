"""A program in older spellings, with line numbers and joined rows, is the same program."""

from __future__ import annotations

import re

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from desire_tui.engine.diagnostics import render_all
from desire_tui.engine.source import Source
from desire_tui.engine.syntax.line_numbers import with_numbers
from desire_tui.engine.syntax.parse import parse
from tests.strategies import programs
from tests.syntax.format.program import format_program

OLDER: tuple[tuple[str, tuple[str, ...]], ...] = (
    (r"^Vectr delta (?=\w)", ("delta ", "UPDATE ", "Delta ", "VECTR delta ", "VECTOR delta ")),
    (r"^Vectr d/dt ", ("MAT d/dt ", "Mat d/dt ", "VECTOR d/dt ", "MATRIX d/dt ")),
    (r"^Vector (?=\w)", ("VECTOR ", "Vectr ", "VECTR ")),
    (r"^MATRIX (?=\w)", ("MAT ", "Mat ", "Matrix ")),
    (r"^DELTA (?=\w)", ("LEARN ",)),
    (r"^ARRAY ", ("dimension ",)),
    (r"^SUBMODEL ", ("MACRO ",)),
    (r"^SUBMODEL (\w+)\((.*)\)$", (r"SUBMODEL \1[\2)", r"MACRO \1(\2]")),
    (r"^invoke (\w+)\((.*)\)$", (r"invoke \1[\2)", r"invoke \1(\2]", r"invoke \1[\2]")),
    (r"^(t?delay \S+ = \w+)\((.*)\)$", (r"\1, \2", r"\1; \2", r"\1(\2", r"\1, \2)")),
    (r"^(CLEARN \w+ = \w+)\((\w+)\)", (r"\1*\2;", r"\1*\2,", r"\1(\2),")),
    (r"^((?:PLEARN|INTP) \w+ = \w+)\*(\w+);", (r"\1*\2,", r"\1(\2)", r"\1(\2);")),
)
"""What the formatter writes, and what else the original reads there."""


def respelled(statement: str, draw) -> str:
    """Return a statement in one of the spellings it may have."""
    for pattern, others in OLDER:
        if re.search(pattern, statement) and draw(st.booleans()):
            statement = re.sub(pattern, draw(st.sampled_from(others)), statement)
    return statement


def joined(row: str, draw) -> str:
    """Break a row somewhere by `_`, unless a blank begins it there."""
    at = draw(st.integers(1, max(1, len(row) - 1)))
    if at >= len(row) or row[at].isspace() or row[:at].isspace() or row[:at].rstrip().isdigit():
        return row
    return f"{row[:at]}_\n{row[at:]}"


def trees(text):
    program = parse(Source(text))
    assert not program.problems, render_all(program.problems)
    return [
        [placed.node for placed in program.script],
        [(s.label, [p.node for p in s.body], [p.node for p in s.jacobian]) for s in program.segments],
    ]


@settings(deadline=None, max_examples=100)
@given(programs(), st.data())
def test_an_older_text_is_the_same_program(program, data) -> None:
    text = format_program(program)
    rows = text.split("\n")[:-1]
    indents = [len(row) - len(row.lstrip()) for row in rows]
    older = [
        " " * indent + respelled(row[indent:], data.draw) for row, indent in zip(rows, indents, strict=True)
    ]
    if data.draw(st.booleans()):
        older = with_numbers("".join(f"{row}\n" for row in older)).split("\n")[:-1]
    broken = [joined(row, data.draw) if data.draw(st.booleans()) else row for row in older]
    assert trees("".join(f"{row}\n" for row in broken)) == trees(text)


@pytest.mark.parametrize(
    ("older", "canonical"),
    [
        ("func y = F, x", "func y = F(x"),
        ("func y = F; x)", "func y = F(x)"),
        ("func2 y = F, x, y; X, Y", "func2 y = F(x, y; X, Y)"),
        ("s[a, b)", "s(a, b)"),
        ("s(a; b]", "s(a, b)"),
        ("SHOW A; 3", "SHOW A, 3"),
        ("CLEARN y = W*x, 1; 0#", "CLEARN y = W(x) 1, 0#"),
        ("delta h = v; 0; 1", "Delta h = v; 0, 1"),
        ("edit 210 - 220 ; 240", "edit 210 - 220 ; 240 -- here"),
    ],
)
def test_forms_that_the_formatter_does_not_write(older, canonical) -> None:
    assert trees(f"DYNAMIC\n{older}\n") == trees(f"DYNAMIC\n{canonical}\n")
