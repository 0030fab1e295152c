"""SBML's mathematics (MathML) as expressions."""

from __future__ import annotations

import math
from functools import cache
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from desire_tui.convert.expressions import (
    ONE,
    PI,
    TIME,
    ZERO,
    Binary,
    Call,
    Choice,
    Expression,
    Logical,
    Name,
    Negative,
    Not,
    Number,
    Relation,
    number,
    total,
)
from desire_tui.convert.sbml.document import library

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

AVOGADRO = 6.02214179e23
"""The value that SBML's specification (level 3, section 3.4.6) fixes for its symbol."""
RATE_OF = "rate of"
"""Stands for the derivative of a quantity until that is known: no function can be called so."""


class UnknownMathError(Exception):
    """A formula that cannot be said here: the reason."""


def expression_of(node: Any) -> Expression:
    """Return a formula as an expression. UnknownMathError."""
    if node is None:
        raise UnknownMathError("it has no formula")
    if not node.isWellFormedASTNode():
        raise UnknownMathError("it is no complete formula")
    found = _kinds().get(node.getType())
    if found is None:
        what = node.getName() or library().formulaToL3String(node)
        raise UnknownMathError(f"'{what}' has no counterpart here")
    return found(node)


def _children(node: Any) -> list[Expression]:
    return [expression_of(node.getChild(k)) for k in range(node.getNumChildren())]


@cache
def _kinds() -> Mapping[int, Callable[[Any], Expression]]:
    """Return what to do with each type of node."""
    lib = library()
    kinds: dict[int, Callable[[Any], Expression]] = {
        lib.AST_INTEGER: lambda node: number(float(node.getInteger())),
        lib.AST_REAL: lambda node: _real(node.getReal()),
        lib.AST_REAL_E: lambda node: _real(node.getReal()),
        lib.AST_RATIONAL: lambda node: Binary(
            "/", number(float(node.getNumerator())), number(float(node.getDenominator()))
        ),
        lib.AST_NAME: lambda node: Name(node.getName()),
        lib.AST_NAME_TIME: lambda _: TIME,
        lib.AST_NAME_AVOGADRO: lambda _: Number(AVOGADRO),
        lib.AST_CONSTANT_PI: lambda _: PI,
        lib.AST_CONSTANT_E: lambda _: Call("exp", (ONE,)),
        lib.AST_CONSTANT_TRUE: lambda _: ONE,
        lib.AST_CONSTANT_FALSE: lambda _: ZERO,
        lib.AST_PLUS: lambda node: total(_children(node)),
        lib.AST_TIMES: _times,
        lib.AST_MINUS: _minus,
        lib.AST_DIVIDE: lambda node: Binary("/", *_children(node)),
        lib.AST_POWER: lambda node: Binary("^", *_children(node)),
        lib.AST_FUNCTION_POWER: lambda node: Binary("^", *_children(node)),
        lib.AST_FUNCTION_PIECEWISE: _piecewise,
        lib.AST_FUNCTION_DELAY: lambda node: Call("delay", tuple(_children(node))),
        lib.AST_FUNCTION_RATE_OF: lambda node: Call(RATE_OF, tuple(_children(node))),
        lib.AST_FUNCTION_ROOT: _root,
        lib.AST_FUNCTION_LOG: _log,
        lib.AST_FUNCTION_FACTORIAL: _factorial,
        lib.AST_FUNCTION_QUOTIENT: lambda node: Call("trnc", (Binary("/", *_children(node)),)),
        lib.AST_FUNCTION_REM: _rem,
        lib.AST_FUNCTION_MAX: lambda node: _chained("max", _children(node)),
        lib.AST_FUNCTION_MIN: lambda node: _chained("min", _children(node)),
        lib.AST_LOGICAL_AND: lambda node: _logical("and", _children(node)),
        lib.AST_LOGICAL_OR: lambda node: _logical("or", _children(node)),
        lib.AST_LOGICAL_NOT: lambda node: Not(*_children(node)),
        lib.AST_LOGICAL_XOR: _xor,
        lib.AST_LOGICAL_IMPLIES: _implies,
    }  # fmt: skip
    for sign, types in (("=", "EQ"), ("<>", "NEQ"), ("<", "LT"), (">", "GT"), ("<=", "LEQ"), (">=", "GEQ")):
        kinds[getattr(lib, f"AST_RELATIONAL_{types}")] = _relation(sign)
    for name, function in _SAME.items():
        kinds[getattr(lib, f"AST_FUNCTION_{name}")] = _same(function)
    for name, formula in _FORMULAS.items():
        kinds[getattr(lib, f"AST_FUNCTION_{name}")] = _composed(formula)
    return kinds


_SAME = {
    "ABS": "abs", "CEILING": "ceil", "FLOOR": "floor", "EXP": "exp", "LN": "ln", "SIN": "sin", "COS": "cos",
    "TAN": "tan", "SINH": "sinh", "COSH": "cosh", "TANH": "tanh", "ARCSIN": "asin", "ARCCOS": "acos",
    "ARCTAN": "atan",
}  # fmt: skip


def _inverse(x: Expression) -> Expression:
    return Binary("/", ONE, x)


def _square(x: Expression) -> Expression:
    return Binary("^", x, Number(2.0))


def _one(function: str, x: Expression) -> Expression:
    return Call(function, (x,))


def _arsinh(x: Expression) -> Expression:
    return _one("ln", Binary("+", x, _one("sqrt", Binary("+", _square(x), ONE))))


def _arcosh(x: Expression) -> Expression:
    return _one("ln", Binary("+", x, _one("sqrt", Binary("-", _square(x), ONE))))


def _artanh(x: Expression) -> Expression:
    ratio = Binary("/", Binary("+", ONE, x), Binary("-", ONE, x))
    return Binary("/", _one("ln", ratio), Number(2.0))


_FORMULAS: dict[str, Callable[[Expression], Expression]] = {
    "SEC": lambda x: _inverse(_one("cos", x)), "CSC": lambda x: _inverse(_one("sin", x)),
    "COT": lambda x: _inverse(_one("tan", x)), "SECH": lambda x: _inverse(_one("cosh", x)),
    "CSCH": lambda x: _inverse(_one("sinh", x)), "COTH": lambda x: _inverse(_one("tanh", x)),
    "ARCSEC": lambda x: _one("acos", _inverse(x)), "ARCCSC": lambda x: _one("asin", _inverse(x)),
    "ARCCOT": lambda x: _one("atan", _inverse(x)), "ARCSINH": _arsinh, "ARCCOSH": _arcosh, "ARCTANH": _artanh,
    "ARCSECH": lambda x: _arcosh(_inverse(x)), "ARCCSCH": lambda x: _arsinh(_inverse(x)),
    "ARCCOTH": lambda x: _artanh(_inverse(x)),
}  # fmt: skip
"""Functions that Desire has not, by those that it has."""


def _same(function: str) -> Callable[[Any], Expression]:
    return lambda node: Call(function, tuple(_children(node)))


def _composed(formula: Callable[[Expression], Expression]) -> Callable[[Any], Expression]:
    return lambda node: formula(*_children(node))


def _real(value: float) -> Expression:
    if not math.isfinite(value):
        raise UnknownMathError("Desire writes no infinity and no NaN")
    return number(value)


def _times(node: Any) -> Expression:
    factors = _children(node)
    if not factors:
        return ONE
    result = factors[0]
    for factor in factors[1:]:
        result = Binary("*", result, factor)
    return result


def _minus(node: Any) -> Expression:
    operands = _children(node)
    return Negative(operands[0]) if len(operands) == 1 else Binary("-", *operands)


def _piecewise(node: Any) -> Expression:
    parts = _children(node)
    result = parts.pop() if len(parts) % 2 else None
    if result is None:  # where no condition holds it has no value
        result = parts[-2]
        parts = parts[:-2]
    for k in range(len(parts) - 2, -1, -2):
        result = Choice(parts[k + 1], parts[k], result)
    return result


def _root(node: Any) -> Expression:
    parts = _children(node)
    degree, radicand = parts if len(parts) == 2 else (Number(2.0), parts[0])
    if isinstance(degree, Number) and degree.value == 2:
        return Call("sqrt", (radicand,))
    return Binary("^", radicand, _inverse(degree))


def _log(node: Any) -> Expression:
    parts = _children(node)
    base, argument = parts if len(parts) == 2 else (Number(10.0), parts[0])
    if isinstance(base, Number) and base.value == 10:
        return Call("log", (argument,))
    return Binary("/", Call("ln", (argument,)), Call("ln", (base,)))


def _factorial(node: Any) -> Expression:
    (operand,) = _children(node)
    if isinstance(operand, Number) and operand.value == int(operand.value) and operand.value <= 170:
        return number(float(math.factorial(int(operand.value))))
    raise UnknownMathError("the factorial of what is no whole constant has no counterpart here")


def _rem(node: Any) -> Expression:
    left, right = _children(node)
    return Binary("-", left, Binary("*", right, Call("trnc", (Binary("/", left, right),))))


def _chained(function: str, operands: list[Expression]) -> Expression:
    result = operands[0]
    for operand in operands[1:]:
        result = Call(function, (result, operand))
    return result


def _logical(operator: str, operands: list[Expression]) -> Expression:
    if not operands:
        return ONE if operator == "and" else ZERO
    result = operands[0]
    for operand in operands[1:]:
        result = Logical("and" if operator == "and" else "or", result, operand)
    return result


def _truth(operand: Expression) -> Expression:
    return operand if isinstance(operand, Relation | Logical | Not) else Relation("<>", operand, ZERO)


def _xor(node: Any) -> Expression:
    operands = _children(node)
    result = operands[0] if operands else ZERO
    for operand in operands[1:]:
        result = Relation("<>", _truth(result), _truth(operand))
    return result


def _implies(node: Any) -> Expression:
    first, second = _children(node)
    return Logical("or", Not(first), second)


def _relation(sign: str) -> Callable[[Any], Expression]:
    def of(node: Any) -> Expression:
        operands = _children(node)
        pairs = [
            Relation(sign, left, right)  # type: ignore[arg-type]
            for left, right in pairwise(operands)
        ]
        return _logical("and", list(pairs))

    return of
