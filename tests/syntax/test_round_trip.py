"""Trees to text and back; texts that are no programs never crash anything."""

from __future__ import annotations

import operator
import re

from hypothesis import given, settings
from hypothesis import strategies as st

from desire_tui.engine.diagnostics import render_all
from desire_tui.engine.nodes.expressions import Binary, Expr, Number, Unary
from desire_tui.engine.nodes.record import Node
from desire_tui.engine.source import Source
from desire_tui.engine.structure.structure import structure
from desire_tui.engine.syntax.highlighting import highlight
from desire_tui.engine.syntax.parse import parse, parse_command
from desire_tui.engine.syntax.shapes import forget
from tests.strategies import broken_texts, programs, statements
from tests.syntax.format.program import format_program
from tests.syntax.format.statements import format_statement


@settings(deadline=None, max_examples=300)
@given(statements)
def test_a_statement_parses_back_to_itself(node) -> None:
    text = format_statement(node)
    for _ in range(3):  # from the grammar, from the pattern, from the generated function
        placed, problems = parse_command(Source(text))
        assert not problems, render_all(problems)
        assert [p.node for p in placed] == [node]
    assert text == format_statement(placed[0].node)


@settings(deadline=None, max_examples=60)
@given(programs())
def test_a_program_parses_back_to_itself(program) -> None:
    again = parse(Source(format_program(program)))
    assert not again.problems, render_all(again.problems)
    assert [p.node for p in again.script] == [p.node for p in program.script]
    assert len(again.segments) == len(program.segments)
    for one, other in zip(again.segments, program.segments, strict=True):
        assert one.label == other.label
        assert [p.node for p in one.body] == [p.node for p in other.body]
        assert [p.node for p in one.jacobian] == [p.node for p in other.jacobian]


@settings(deadline=None, max_examples=400)
@given(broken_texts)
def test_any_text_is_survived(text) -> None:
    source = Source(text, "f")
    program = parse(source)
    problems = [*program.problems, *structure(program).problems]
    for problem in problems:
        assert problem.span is not None
        assert 0 <= problem.span.start <= problem.span.end <= len(text) + 1
    assert render_all(problems).count("f:") >= len(problems)
    _, problems = parse_command(source)
    render_all(problems)
    for line in text.split("\n"):
        classes = highlight(line)
        ends = [0, *(end for _, end, _ in classes)]
        assert all(
            before <= start < end <= len(line) for before, (start, end, _) in zip(ends, classes, strict=False)
        )


@settings(deadline=None, max_examples=200)
@given(broken_texts)
def test_the_generated_function_agrees_with_the_grammar(text) -> None:
    """Parsing a text anew from the grammar gives nodes at the same places as the shape's function does."""
    from desire_tui.engine.syntax.parsed_lines import forget_lines

    results = []
    forget()
    for _ in range(3):
        forget_lines()
        program = parse(Source(text))
        results.append([(p.at, _places(p.node)) for p in program.script])
    assert results[0] == results[1] == results[2]


def _places(part: object) -> object:
    if isinstance(part, Node):
        return (type(part).__name__, [_places(getattr(part, name)) for name in part.__slots__])
    return [_places(item) for item in part] if isinstance(part, tuple) else part


OPERATIONS = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.truediv,
    "^": operator.pow,
}
arithmetic = st.recursive(
    st.sampled_from(["2", "3", "0.5", "1.25"]),
    lambda inner: st.one_of(
        st.tuples(inner, st.sampled_from("+-*/"), inner).map("".join),
        inner.map("({})".format),
        st.tuples(st.sampled_from(["-", "+"]), inner).map("".join),
        st.tuples(st.sampled_from(["2", "3"]), st.sampled_from(["^2", "^-1", "^2^0.5", "^-1^2"])).map(
            "".join
        ),
    ),
    max_leaves=10,
)


@settings(deadline=None, max_examples=300)
@given(arithmetic)
def test_operators_bind_as_in_python(text) -> None:
    """Precedence and associativity against an independent reader: Python's, which has the same rules for these."""
    text = re.sub("-(?=-)", "- ", text)  # `--` begins a comment
    placed, problems = parse_command(Source(text))
    assert not problems
    try:
        wanted = eval(text.replace("^", "**"))
    except ZeroDivisionError:
        return
    assert _value(placed[0].node.value) == wanted


def _value(node: Expr) -> float:
    match node:
        case Number(value):
            return value
        case Unary(op, operand):
            return -_value(operand) if op == "-" else _value(operand)
        case Binary(op, left, right):
            return OPERATIONS[op](_value(left), _value(right))
    raise TypeError(node)
