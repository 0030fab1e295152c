"""Expressions as Desire's texts: what a program computes from them is what they mean."""

from __future__ import annotations

import math
from random import Random

import pytest

import desire_tui
from desire_tui.convert.expression_text import expression_text, number_text
from desire_tui.convert.expressions import (
    Binary,
    Call,
    Choice,
    Logical,
    Name,
    Negative,
    Not,
    Relation,
    number,
)
from desire_tui.convert.layout import WIDTH, broken

VALUES = {"a": 2.0, "b": -0.5, "c": 3.0}
COMPARE = {
    "<": float.__lt__, ">": float.__gt__, "<=": float.__le__, ">=": float.__ge__, "=": float.__eq__,
    "<>": float.__ne__,
}  # fmt: skip


def value(expression) -> float:
    """Return what an expression is worth, computed by Python."""
    match expression:
        case Name(name):
            return VALUES[name]
        case Negative(operand):
            return -value(operand)
        case Binary("^", left, right):
            return value(left) ** value(right)
        case Binary(operator, left, right):
            x, y = value(left), value(right)
            return {"+": x + y, "-": x - y, "*": x * y, "/": x / y if y else math.nan}[operator]
        case Relation(sign, left, right):
            return float(COMPARE[sign](value(left), value(right)))
        case Logical(operator, left, right):
            x, y = value(left) != 0, value(right) != 0
            return float(x and y if operator == "and" else x or y)
        case Not(operand):
            return float(value(operand) == 0)
        case Choice(condition, then, otherwise):
            return value(then) if value(condition) else value(otherwise)
        case Call("max", (left, right)):
            return max(value(left), value(right))
        case _:
            return expression.value


def grown(random: Random, depth: int):
    """Return a random expression whose powers and quotients have a value."""
    if depth == 0:
        return random.choice([*map(Name, VALUES), number(0.0), number(2.5), number(-4.0)])
    one, other = grown(random, depth - 1), grown(random, random.randrange(depth))
    return random.choice([
        lambda: Negative(one), lambda: Not(one), lambda: Choice(other, one, other),
        lambda: Binary(random.choice("+-*"), one, other), lambda: Binary("/", one, Name("c")),
        lambda: Binary("^", one, number(2.0)), lambda: Binary("^", Name("a"), Binary("^", Name("c"), Name("b"))),
        lambda: Relation(random.choice([*COMPARE]), one, other), lambda: Call("max", (one, other)),
        lambda: Logical(random.choice(["and", "or"]), one, other),
        lambda: Logical("or", Logical("and", other, one), Not(other)),
    ])()  # fmt: skip


def test_what_a_program_computes_is_what_they_mean():
    random = Random(5)
    found = [grown(random, random.randrange(1, 5)) for _ in range(300)]
    lines = [line for k, one in enumerate(found) for line in broken(f"e{k} = {expression_text(one)}")]
    assert max(map(len, lines)) <= WIDTH
    start = " | ".join(f"{name} = {number_text(value)}" for name, value in VALUES.items())
    text = "\n".join(
        [start, "TMAX = 1 | DT = 0.5 | NN = 2", "drun", "DYNAMIC", "d/dt s = 1", *lines, "dispt s"]
    )
    run = desire_tui.load(text).run(record=[f"e{k}" for k in range(len(found))], check=True)
    for k, one in enumerate(found):
        assert run[f"e{k}"][0] == pytest.approx(value(one), rel=1e-12, nan_ok=True), expression_text(one)


@pytest.mark.parametrize(
    ("expression", "text"),
    [
        (Binary("-", Name("a"), Binary("-", Name("b"), Name("c"))), "a - (b - c)"),
        (Binary("^", Binary("^", Name("a"), Name("b")), Name("c")), "(a^b)^c"),
        (Binary("^", Name("a"), Negative(Name("b"))), "a^-b"),
        (Binary("^", Negative(Name("a")), Name("b")), "(-a)^b"),
        (Binary("/", Name("a"), Binary("*", Name("b"), Name("c"))), "a/(b*c)"),
        (Logical("or", Name("a"), Relation(">", Negative(Name("b")), number(1.0))), "(a <> 0 or (-b > 1))"),
        (Call("func1", (Name("a"), Name("w"))), "func1(a; w)"),
    ],
)
def test_as_few_parentheses_as_the_grammar_allows(expression, text):
    assert expression_text(expression) == text
