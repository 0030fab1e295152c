"""Derivatives of the library functions, as lowered expressions of their arguments.

Each of the `DERIVATIVE_RULES` takes the arguments x, … and their tangents x', … (None where a tangent is 0)
and returns the tangent of the function's value, None for 0. Where a function has a kink, the derivative is
that of one of its sides.
"""

from __future__ import annotations

from math import log as natural_log
from typing import TYPE_CHECKING

from desire_tui.engine.lowered.expressions import Const, Op

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from desire_tui.engine.lowered.expressions import Value

    Tangent = Value | None
    DerivativeRule = Callable[[Sequence[Value], Sequence[Tangent]], Tangent]

ZERO, ONE, TWO = Const(0.0), Const(1.0), Const(2.0)


def op(name: str, *args: Value) -> Value:
    """Make an operation."""
    return Op(name, args)


def times(factor: Value, tangent: Tangent) -> Tangent:
    """Return factor·tangent."""
    return None if tangent is None else op("mul", factor, tangent)


def plus(a: Tangent, b: Tangent) -> Tangent:
    """Return a + b."""
    if a is None or b is None:
        return b if a is None else a
    return op("add", a, b)


def minus(a: Tangent, b: Tangent) -> Tangent:
    """Return a − b."""
    if b is None:
        return a
    return op("neg", b) if a is None else op("sub", a, b)


def _square(x: Value) -> Value:
    return op("mul", x, x)


def _product(x: Sequence[Value], d: Sequence[Tangent]) -> Tangent:
    return plus(times(x[1], d[0]), times(x[0], d[1]))


def _quotient(x: Sequence[Value], d: Sequence[Tangent]) -> Tangent:
    top = minus(d[0], times(op("div", x[0], x[1]), d[1]))
    return None if top is None else op("div", top, x[1])


def _integer_power(x: Sequence[Value], d: Sequence[Tangent]) -> Tangent:
    assert isinstance(x[1], Const)
    n = x[1].value
    if n == 0.0 or d[0] is None:
        return None
    if n == 1.0:
        return d[0]
    lower = x[0] if n == 2.0 else op("ipow", x[0], Const(n - 1.0))
    return op("mul", op("mul", x[1], lower), d[0])


def _power(x: Sequence[Value], d: Sequence[Tangent]) -> Tangent:
    base = times(op("mul", x[1], op("pow", x[0], op("sub", x[1], ONE))), d[0])
    return plus(base, times(op("comp", x[0], ZERO, op("mul", op("pow", *x), op("ln", x[0]))), d[1]))


def _factor(factor: Callable[[Value], Value]) -> DerivativeRule:
    """Make a rule out of f'(x)."""
    return lambda x, d: None if d[0] is None else op("mul", factor(x[0]), d[0])


def _divisor(divisor: Callable[[Value], Value]) -> DerivativeRule:
    """Make a rule out of 1/f'(x)."""
    return lambda x, d: None if d[0] is None else op("div", d[0], divisor(x[0]))


def _negative(rule: DerivativeRule) -> DerivativeRule:
    return lambda x, d: minus(None, rule(x, d))


def _zero(_x: Sequence[Value], _d: Sequence[Tangent]) -> Tangent:
    return None


def _sum(_x: Sequence[Value], d: Sequence[Tangent]) -> Tangent:
    return plus(d[0], d[1])


def _difference(_x: Sequence[Value], d: Sequence[Tangent]) -> Tangent:
    return minus(d[0], d[1])


def _negation(_x: Sequence[Value], d: Sequence[Tangent]) -> Tangent:
    return minus(None, d[0])


def _atan2(x: Sequence[Value], d: Sequence[Tangent]) -> Tangent:
    top = minus(times(x[1], d[0]), times(x[0], d[1]))
    return None if top is None else op("div", top, op("add", _square(x[0]), _square(x[1])))


def choose(control: Value, negative: Tangent, positive: Tangent) -> Tangent:
    """Return `positive` where control > 0, else `negative`."""
    if negative is None and positive is None:
        return None
    return op("comp", control, negative or ZERO, positive or ZERO)


def _root(x: Sequence[Value], d: Sequence[Tangent]) -> Tangent:
    """Return 0 at 0, where the slope is infinite: what starts there (an empty tank) has to go on."""
    return None if d[0] is None else op("comp", x[0], ZERO, op("div", d[0], op("mul", TWO, op("sqrt", x[0]))))


def _sinc(x: Value) -> Value:
    derivative = op("div", op("sub", op("cos", x), op("sinc", x)), x)
    return op("comp", op("abs", x), ZERO, derivative)


def _sigmoid(x: Value) -> Value:
    y = op("sigmoid", x)
    return op("mul", y, op("sub", ONE, y))


def _rational_sigmoid(x: Value) -> Value:
    return op("div", op("mul", TWO, op("lim", x)), _square(op("add", ONE, _square(x))))


_ARC = _divisor(lambda x: op("sqrt", op("sub", ONE, _square(x))))

DERIVATIVE_RULES: dict[str, DerivativeRule] = {
    "add": _sum,
    "sub": _difference,
    "neg": _negation,
    "mul": _product,
    "div": _quotient,
    "ipow": _integer_power,
    "pow": _power,
    "sin": _factor(lambda x: op("cos", x)),
    "cos": _factor(lambda x: op("neg", op("sin", x))),
    "tan": _factor(lambda x: op("add", ONE, _square(op("tan", x)))),
    "asin": _ARC,
    "acos": _negative(_ARC),
    "atan": _divisor(lambda x: op("add", ONE, _square(x))),
    "sinh": _factor(lambda x: op("cosh", x)),
    "cosh": _factor(lambda x: op("sinh", x)),
    "tanh": _factor(lambda x: op("sub", ONE, _square(op("tanh", x)))),
    "exp": _factor(lambda x: op("exp", x)),
    "sqrt": _root,
    "abs": _factor(lambda x: op("sgn", x)),
    "ln": _divisor(lambda x: x),
    "log": _divisor(lambda x: op("mul", Const(natural_log(10.0)), x)),
    "atan2": _atan2,
    "lim": _factor(lambda x: op("swtch", x)),
    "sat": _factor(lambda x: op("rect", x)),
    "SAT": _factor(lambda x: op("rect", op("sub", op("mul", TWO, x), ONE))),
    "deadz": _factor(lambda x: op("sub", ONE, op("rect", x))),
    "deadc": _zero,
    "swtch": _zero,
    "sgn": _zero,
    "comp": lambda x, d: choose(x[0], d[1], d[2]),
    "rect": _zero,
    "tri": _factor(lambda x: op("neg", op("sgn", x))),
    "sinc": _factor(_sinc),
    "sigmoid": _factor(_sigmoid),
    "SIGMOID": _factor(_rational_sigmoid),
    "round": _zero,
    "trnc": _zero,
    "floor": _zero,
    "recip": _divisor(lambda x: op("neg", _square(x))),
    "max": lambda x, d: choose(op("sub", x[0], x[1]), d[1], d[0]),
    "min": lambda x, d: choose(op("sub", x[0], x[1]), d[0], d[1]),
}
"""By the names of `lowered.Op`; `ran` and `gauss` have no derivative."""
