"""The library of language.md 4.1 as instructions, one formula each, scalar or several lanes wide.

A comparison with nan is false, so each formula is written so that nan falls through to x itself.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.codegen.ir.lanes import Lanes

C_FUNCTIONS = {
    "sin": "sin", "cos": "cos", "tan": "tan", "asin": "asin", "acos": "acos", "atan": "atan", "sinh": "sinh",
    "cosh": "cosh", "tanh": "tanh", "exp": "exp", "ln": "log", "log": "log10", "pow": "pow", "atan2": "atan2",
}  # fmt: skip
"""Functions that are the C library's, by their names there."""
LIBRARY_OPERATIONS = frozenset((*C_FUNCTIONS, "sinc", "sigmoid"))
"""Operations that call it."""


def apply(lanes: Lanes, name: str, args: list[str]) -> str:
    """Write the operation `name` (lowered.Op); return its value. KeyError for a name that does not exist."""
    simple = C_FUNCTIONS.get(name)
    if simple is not None:
        return lanes.call_library(simple, *args)
    return _FORMULAS[name](lanes, *args)


def power(lanes: Lanes, x: str, exponent: int) -> str:
    """Write x to a whole power as products, binary powering from the top bit; negative: 1 / x^|n|."""
    if exponent == 0:
        return lanes.const(1.0)
    result = x
    for bit in bin(abs(exponent))[3:]:
        result = lanes.mul(result, result)
        if bit == "1":
            result = lanes.mul(result, x)
    return lanes.div(lanes.const(1.0), result) if exponent < 0 else result


def _where(lanes: Lanes, x: str, relation: str, limit: float, yes: str, no: str) -> str:
    return lanes.choose(lanes.compare(relation, x, lanes.const(limit)), yes, no)


def _clip(lanes: Lanes, x: str, low: float) -> str:
    below = _where(
        lanes, x, "ole", low, lanes.const(low), x
    )  # SAT(-0) is 0, as of every x that is not above 0
    return _where(lanes, x, "ogt", 1.0, lanes.const(1.0), below)


def _lim(lanes: Lanes, x: str) -> str:
    return _where(lanes, x, "ole", 0.0, lanes.const(0.0), x)


def _comp(lanes: Lanes, x: str, minus: str, plus: str) -> str:
    return _where(lanes, x, "ogt", 0.0, plus, _where(lanes, x, "ole", 0.0, minus, x))


def _sgn(lanes: Lanes, x: str) -> str:
    zero = lanes.add(x, lanes.const(0.0))  # 0 for -0, nan for nan
    other = _where(lanes, x, "olt", 0.0, lanes.const(-1.0), zero)
    return _where(lanes, x, "ogt", 0.0, lanes.const(1.0), other)


def _deadc(lanes: Lanes, x: str) -> str:
    inside = _where(lanes, x, "ole", 1.0, lanes.const(0.0), x)
    low = _where(lanes, x, "olt", -1.0, lanes.const(-1.0), inside)
    return _where(lanes, x, "ogt", 1.0, lanes.const(1.0), low)


def _rect(lanes: Lanes, x: str) -> str:
    size = lanes.intrinsic("fabs", x)
    outside = _where(lanes, size, "oge", 1.0, lanes.const(0.0), x)
    return _where(lanes, size, "olt", 1.0, lanes.const(1.0), outside)


def maximum(lanes: Lanes, x: str, y: str) -> str:
    """Write the larger of two; x of equal ones, nan where either is nan."""
    larger = lanes.choose(lanes.compare("ole", y, x), x, y)
    return lanes.choose(lanes.compare("uno", x, x), x, larger)


def minimum(lanes: Lanes, x: str, y: str) -> str:
    """Write the smaller of two; x of equal ones, nan where either is nan."""
    smaller = lanes.choose(lanes.compare("oge", y, x), x, y)
    return lanes.choose(lanes.compare("uno", x, x), x, smaller)


def _sigmoid(lanes: Lanes, x: str) -> str:
    grown = lanes.call_library("exp", lanes.neg(x))
    return lanes.div(lanes.const(1.0), lanes.add(lanes.const(1.0), grown))


def _soft_step(lanes: Lanes, x: str) -> str:
    square = lanes.mul(x, x)
    ratio = lanes.div(square, lanes.add(lanes.const(1.0), square))
    ratio = lanes.choose(lanes.compare("oeq", square, lanes.const(float("inf"))), lanes.const(1.0), ratio)
    return lanes.choose(lanes.compare("ole", x, lanes.const(0.0)), lanes.const(0.0), ratio)


def _sinc(lanes: Lanes, x: str) -> str:
    ratio = lanes.div(lanes.call_library("sin", x), x)
    return lanes.choose(lanes.compare("oeq", x, lanes.const(0.0)), lanes.const(1.0), ratio)


_FORMULAS: dict[str, Callable[..., str]] = {
    "add": lambda e, a, b: e.add(a, b),
    "sub": lambda e, a, b: e.sub(a, b),
    "mul": lambda e, a, b: e.mul(a, b),
    "div": lambda e, a, b: e.div(a, b),
    "neg": lambda e, a: e.neg(a),
    "sqrt": lambda e, a: e.intrinsic("sqrt", a),
    "abs": lambda e, a: e.intrinsic("fabs", a),
    "round": lambda e, a: e.intrinsic("round", a),
    "trnc": lambda e, a: e.intrinsic("trunc", a),
    "floor": lambda e, a: e.intrinsic("floor", a),
    "recip": lambda e, a: e.div(e.const(1.0), a),
    "lim": _lim,
    "swtch": lambda e, a: _comp(e, a, e.const(0.0), e.const(1.0)),
    "comp": _comp,
    "sat": lambda e, a: _clip(e, a, -1.0),
    "SAT": lambda e, a: _clip(e, a, 0.0),
    "deadz": lambda e, a: e.sub(a, _clip(e, a, -1.0)),
    "deadc": _deadc,
    "sgn": _sgn,
    "rect": _rect,
    "tri": lambda e, a: e.sub(e.const(1.0), e.intrinsic("fabs", a)),
    "sinc": _sinc,
    "sigmoid": _sigmoid,
    "SIGMOID": _soft_step,
    "max": maximum,
    "min": minimum,
}
