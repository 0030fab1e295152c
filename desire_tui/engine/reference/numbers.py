"""IEEE 754 arithmetic and the function library, for Python floats and for NumPy arrays alike.

Python raises where compiled code gives inf or nan; here both give inf or nan.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from desire_tui.engine.library import LIBRARY

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Number = float | Array

_WHOLE_FROM = 4503599627370496.0  # 2^52: larger doubles are whole already


def divide(a: float, b: float) -> float:
    """Return a/b; division by zero gives inf or nan."""
    try:
        return a / b
    except ZeroDivisionError:
        if a != a or a == 0.0:  # noqa: PLR0124 - nan
            return math.nan
        return math.copysign(math.inf, a) * math.copysign(1.0, b)


def power(x: float, y: float) -> float:
    """Return C's pow(x, y)."""
    try:
        return math.pow(x, y)
    except (ValueError, OverflowError):
        with np.errstate(all="ignore"):
            return float(np.power(np.float64(x), np.float64(y)))


def integer_power(x: Number, n: int) -> Number:
    """Return x^n by repeated products: binary powering from the top bit, negative n as 1/x^|n|."""
    if n == 0:
        return np.ones_like(x) if isinstance(x, np.ndarray) else 1.0
    value = x
    for bit in bin(abs(n))[3:]:
        value = value * value
        if bit == "1":
            value = value * x
    if n > 0:
        return value
    return 1.0 / value if isinstance(value, np.ndarray) else divide(1.0, value)


def _round(x: Array) -> Array:
    whole = np.trunc(x)
    away = np.where(np.abs(x - whole) >= 0.5, whole + np.copysign(1.0, x), whole)
    return np.where(np.abs(x) < _WHOLE_FROM, away, x)


def _sat(x: Array) -> Array:
    return np.where(x > 1.0, 1.0, np.where(x < -1.0, -1.0, x))


def _sinc(x: Array) -> Array:
    return np.where(x == 0.0, 1.0, np.sin(x) / np.where(x == 0.0, 1.0, x))


def _sigmoid_rational(x: Array) -> Array:
    square = x * x
    return np.where(x <= 0.0, 0.0, np.where(np.isinf(square), 1.0, square / (1.0 + square)))


def _comp(x: Array, minus: Number, plus: Number) -> Array:
    return np.where(x > 0.0, plus, np.where(x <= 0.0, minus, x))


ARRAYS: dict[str, Callable[..., Any]] = {
    "add": np.add, "sub": np.subtract, "mul": np.multiply, "div": np.divide, "neg": np.negative,
    "pow": np.power,
    "sin": np.sin, "cos": np.cos, "tan": np.tan, "asin": np.arcsin, "acos": np.arccos, "atan": np.arctan,
    "sinh": np.sinh, "cosh": np.cosh, "tanh": np.tanh, "exp": np.exp, "sqrt": np.sqrt, "abs": np.abs,
    "ln": np.log, "log": np.log10, "atan2": np.arctan2,
    "lim": lambda x: np.where(x <= 0.0, 0.0, x),
    "sat": _sat,
    "SAT": lambda x: np.where(x > 1.0, 1.0, np.where(x <= 0.0, 0.0, x)),
    "deadz": lambda x: x - _sat(x),
    "deadc": lambda x: np.where(x > 1.0, 1.0, np.where(x < -1.0, -1.0, np.where(x <= 1.0, 0.0, x))),
    "swtch": lambda x: _comp(x, 0.0, 1.0),
    "sgn": lambda x: np.where(x > 0.0, 1.0, np.where(x < 0.0, -1.0, x + 0.0)),
    "comp": _comp,
    "rect": lambda x: np.where(np.abs(x) < 1.0, 1.0, np.where(np.isnan(x), x, 0.0)),
    "tri": lambda x: 1.0 - np.abs(x),
    "sinc": _sinc,
    "sigmoid": lambda x: 1.0 / (1.0 + np.exp(-x)),
    "SIGMOID": _sigmoid_rational,
    "round": _round, "trnc": np.trunc, "floor": np.floor, "recip": lambda x: 1.0 / x,
    "max": lambda x, y: np.where((y <= x) | np.isnan(x), x, y),
    "min": lambda x, y: np.where((y >= x) | np.isnan(x), x, y),
}  # fmt: skip
"""Operations of `lowered.Op` over arrays (and scalars mixed with them)."""

SCALARS: dict[str, Callable[..., float]] = {
    "add": lambda a, b: a + b, "sub": lambda a, b: a - b, "mul": lambda a, b: a * b, "div": divide,
    "neg": lambda a: -a, "pow": power,
}  # fmt: skip
"""Operations of `lowered.Op` over numbers that Python does not spoil; the others come from the library."""


def scalar_function(name: str) -> Callable[..., float]:
    """Return an operation over numbers; where Python raises, the IEEE result of the array form is taken."""
    known = SCALARS.get(name)
    if known is not None:
        return known
    plain = LIBRARY[name].value
    array = ARRAYS[name]
    assert plain is not None

    def checked(*args: float) -> float:
        try:
            return plain(*args)  # type: ignore[return-value]  # complex is for scripts only
        except (ArithmeticError, ValueError):
            with np.errstate(all="ignore"):
                return float(array(*(np.float64(a) for a in args)))

    return checked
