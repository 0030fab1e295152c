"""The library of language.md 4.1 as instructions, one formula each, scalar or several lanes wide."""

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


def _clip(lanes: Lanes, x: str, low: float) -> str:
    below = lanes.choose(lanes.compare("olt", x, lanes.const(low)), lanes.const(low), x)
    return lanes.choose(lanes.compare("ogt", x, lanes.const(1.0)), lanes.const(1.0), below)


def _if_positive(lanes: Lanes, x: str, yes: str, no: str) -> str:
    return lanes.choose(lanes.compare("ogt", x, lanes.const(0.0)), yes, no)


def _sgn(lanes: Lanes, x: str) -> str:
    negative = lanes.compare("olt", x, lanes.const(0.0))
    other = lanes.choose(negative, lanes.const(-1.0), lanes.const(0.0))
    return _if_positive(lanes, x, lanes.const(1.0), other)


def _deadc(lanes: Lanes, x: str) -> str:
    low = lanes.choose(lanes.compare("olt", x, lanes.const(-1.0)), lanes.const(-1.0), lanes.const(0.0))
    return lanes.choose(lanes.compare("ogt", x, lanes.const(1.0)), lanes.const(1.0), low)


def _rect(lanes: Lanes, x: str) -> str:
    inside = lanes.compare("olt", lanes.intrinsic("fabs", x), lanes.const(1.0))
    return lanes.choose(inside, lanes.const(1.0), lanes.const(0.0))


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
    "recip": lambda e, a: e.div(e.const(1.0), a),
    "lim": lambda e, a: _if_positive(e, a, a, e.const(0.0)),
    "swtch": lambda e, a: _if_positive(e, a, e.const(1.0), e.const(0.0)),
    "comp": lambda e, a, minus, plus: _if_positive(e, a, plus, minus),
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
    "max": lambda e, a, b: e.choose(e.compare("ogt", b, a), b, a),
    "min": lambda e, a, b: e.choose(e.compare("olt", b, a), b, a),
}
