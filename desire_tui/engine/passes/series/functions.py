"""Library functions of series, by the differential equations that they satisfy.

Each takes operands of which at least one is a series. Knuth, "The Art of Computer Programming" 4.7; Griewank
and Walther, "Evaluating Derivatives", table 13.2.
"""

from __future__ import annotations

from math import log as natural_log
from typing import TYPE_CHECKING

from desire_tui.engine.lowered.expressions import Const, Op
from desire_tui.engine.passes.series.graph import widest
from desire_tui.engine.passes.series.nodes import Constant, Series

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.passes.series.graph import Graph
    from desire_tui.engine.passes.series.nodes import Kind, Operand

    Function = Callable[[Graph, Series], Operand]


_ROOTS = (0.5, 1.5, 2.5)
"""Powers that are a root times a few factors."""
_SINC_SMALL, _SINC_TERMS = 1.0, 16
"""Below, sin(x)/x is taken from its power series up to x^32: its 20th coefficient at 1 has eleven digits."""


def add(g: Graph, a: Operand, b: Operand) -> Operand:
    """Return a + b."""
    if isinstance(a, Constant) and isinstance(b, Constant):
        return g.computed("add", a, b)
    kind: Kind = "raised" if isinstance(a, Constant) or isinstance(b, Constant) else "add"
    return _binary(g, kind, "add", a, b)


def sub(g: Graph, a: Operand, b: Operand) -> Operand:
    """Return a - b."""
    if isinstance(a, Constant):
        if isinstance(b, Constant):
            return g.computed("sub", a, b)
        return add(g, a, neg(g, b))
    return _binary(g, "raised" if isinstance(b, Constant) else "sub", "sub", a, b)


def neg(g: Graph, a: Operand) -> Operand:
    """Return -a."""
    if isinstance(a, Constant):
        return g.computed("neg", a)
    return g.series("neg", Op("neg", (g.value(a),)), a, count=a.count)


def mul(g: Graph, a: Operand, b: Operand) -> Operand:
    """Return a·b."""
    if isinstance(a, Constant) and isinstance(b, Constant):
        return g.computed("mul", a, b)
    kind: Kind = "times" if isinstance(a, Constant) or isinstance(b, Constant) else "mul"
    return _binary(g, kind, "mul", a, b)


def div(g: Graph, a: Operand, b: Operand) -> Operand:
    """Return a/b."""
    if isinstance(b, Constant):
        return g.computed("div", a, b) if isinstance(a, Constant) else _binary(g, "over", "div", a, b)
    return _binary(g, "div", "div", a, b)


def whole_power(g: Graph, a: Operand, n: int) -> Operand:
    """Return a to a whole power, by products as elsewhere: binary powering from the top bit."""
    if n == 0:
        return g.number(1.0)
    result = a
    for bit in bin(abs(n))[3:]:
        result = mul(g, result, result)
        if bit == "1":
            result = mul(g, result, a)
    return result if n > 0 else div(g, g.number(1.0), result)


def power(g: Graph, a: Operand, b: Operand) -> Operand:
    """Return a^b: a·u' = b·u·a' for a constant b, else exp(b·ln a)."""
    if isinstance(b, Series):
        logarithm = g.computed("ln", a) if isinstance(a, Constant) else FUNCTIONS["ln"](g, a)
        exponent = mul(g, b, logarithm)
        assert isinstance(exponent, Series)
        return FUNCTIONS["exp"](g, exponent)
    if isinstance(a, Constant):
        return g.computed("pow", a, b)
    if isinstance(b.value, Const) and b.value.value == 0.5:
        return _sqrt(g, a)
    count = widest(a, b)
    base = a if count == a.count else _spread(g, a, count)
    return g.series("power", _power_now(g.value(base), b.value), base, b, count=count)


def _power_now(base: Value, exponent: Value) -> Value:
    """Return a power at a step's start: r^(-1.5) and the like by a root, in a third of the time."""
    n = exponent.value if isinstance(exponent, Const) else 0.0
    if abs(n) not in _ROOTS:
        return Op("pow", (base, exponent))
    value: Value = Op("sqrt", (base,))
    for _ in range(int(abs(n))):
        value = Op("mul", (base, value))
    return value if n > 0.0 else Op("div", (Const(1.0), value))


def angle(g: Graph, y: Operand, x: Operand) -> Operand:
    """Return atan2(y, x): u' = (x·y' - y·x')/(x² + y²)."""
    if isinstance(x, Constant) and isinstance(y, Constant):
        return g.computed("atan2", y, x)
    square = add(g, mul(g, x, x), mul(g, y, y))
    parts: list[Series] = []
    for inner, factor in ((y, div(g, x, square)), (x, neg(g, div(g, y, square)))):
        if isinstance(inner, Series):
            wide = inner if inner.count == widest(x, y) else _spread(g, inner, widest(x, y))
            part = g.integral(Const(0.0), wide)
            parts.append(g.complete(part, factor, wide))
    value = Op("atan2", (g.value(y), g.value(x)))
    total = parts[0]
    if len(parts) == 2:
        return g.series("add", value, *parts, count=total.count)
    return g.series("raised", value, total, count=total.count)


def choose(g: Graph, condition: Operand, negative: Operand, positive: Operand) -> Operand:
    """Return `comp`: a step ends where its condition passes 0."""
    return g.select(g.held(condition), positive, negative)


def _binary(g: Graph, kind: Kind, name: str, a: Operand, b: Operand) -> Series:
    a, b = (g.stored(o) if isinstance(o, Constant) else o for o in (a, b))
    return g.series(kind, Op(name, (g.value(a), g.value(b))), a, b, count=widest(a, b))


def _spread(g: Graph, a: Series, count: int | None) -> Series:
    """Return an array whose elements are all one number's series."""
    return g.series("times", g.value(a), a, g.number(1.0), count=count)


def _quotient(g: Graph, name: str, a: Series, divisor: Operand) -> Series:
    """Return f(a) with f' = 1/divisor."""
    return g.series("quotient", Op(name, (g.value(a),)), a, divisor, count=a.count)


def _exp(g: Graph, a: Series) -> Operand:
    made = g.integral(Op("exp", (g.value(a),)), a)
    return g.complete(made, made, a)


def _pair(
    g: Graph, a: Series, first: str, second: str, sign: Callable[[Graph, Operand], Operand]
) -> tuple[Series, Series]:
    """Return two functions that are each other's derivative, the second's with a sign."""
    one = g.integral(Op(first, (g.value(a),)), a)
    other = g.integral(Op(second, (g.value(a),)), a)
    g.complete(one, other, a)
    g.complete(other, sign(g, one), a)
    return one, other


def _circular(g: Graph, a: Series) -> tuple[Series, Series]:
    return g.pair(("sin", a), lambda: _pair(g, a, "sin", "cos", neg))


def _hyperbolic(g: Graph, a: Series) -> tuple[Series, Series]:
    return g.pair(("sinh", a), lambda: _pair(g, a, "sinh", "cosh", lambda _, u: u))


def _of_itself(name: str, factor: Callable[[Graph, Series], Operand]) -> Function:
    """Return the function u = name(a) with u' = factor(u)·a'."""

    def function(g: Graph, a: Series) -> Operand:
        made = g.integral(Op(name, (g.value(a),)), a)
        return g.complete(made, factor(g, made), a)

    return function


def _one_plus_square(g: Graph, a: Operand) -> Operand:
    return add(g, g.number(1.0), mul(g, a, a))


def _one_minus_square(g: Graph, a: Operand) -> Operand:
    return sub(g, g.number(1.0), mul(g, a, a))


def _sqrt(g: Graph, a: Series) -> Series:
    return g.series("sqrt", Op("sqrt", (g.value(a),)), a, count=a.count)


def _root(g: Graph, a: Series) -> Operand:
    inner = _one_minus_square(g, a)
    assert isinstance(inner, Series)
    return _sqrt(g, inner)


def _acos(g: Graph, a: Series) -> Operand:
    """-asin(a) with another value at the step's start."""
    minus = neg(g, _quotient(g, "asin", a, _root(g, a)))
    return g.series("raised", Op("acos", (g.value(a),)), minus, count=a.count)


def _sinc(g: Graph, a: Series) -> Operand:
    """Return sin(a)/a, where a is small at a step's start by the power series of sin(x)/x.

    Both are the same function: it is no switch, and no step ends on it. Near 0 the recurrence of the quotient
    would divide by next to nothing.
    """
    size = g.computed("abs", g.held(a))
    is_large = g.stored(g.computed("sub", size, g.number(_SINC_SMALL)))
    square = mul(g, a, a)
    near: Operand = g.number(1.0)
    for n in range(_SINC_TERMS, 0, -1):  # 1 - z/(2·3)·(1 - z/(4·5)·(1 - …))
        near = sub(g, g.number(1.0), mul(g, div(g, square, g.number(2.0 * n * (2.0 * n + 1.0))), near))
    far = div(g, FUNCTIONS["sin"](g, a), a)
    return g.series("select", Op("sinc", (g.value(a),)), is_large, far, near, count=a.count)


FUNCTIONS: dict[str, Function] = {
    "neg": neg,
    "recip": lambda g, a: div(g, g.number(1.0), a),
    "sqrt": _sqrt,
    "exp": _exp,
    "ln": lambda g, a: _quotient(g, "ln", a, a),
    "log": lambda g, a: _quotient(g, "log", a, mul(g, g.number(natural_log(10.0)), a)),
    "sin": lambda g, a: _circular(g, a)[0],
    "cos": lambda g, a: _circular(g, a)[1],
    "sinh": lambda g, a: _hyperbolic(g, a)[0],
    "cosh": lambda g, a: _hyperbolic(g, a)[1],
    "sinc": _sinc,
    "tan": _of_itself("tan", _one_plus_square),
    "tanh": _of_itself("tanh", _one_minus_square),
    "sigmoid": _of_itself("sigmoid", lambda g, u: sub(g, u, mul(g, u, u))),
    "asin": lambda g, a: _quotient(g, "asin", a, _root(g, a)),
    "acos": _acos,
    "atan": lambda g, a: _quotient(g, "atan", a, _one_plus_square(g, a)),
}
"""Of one series."""
