"""Functions of plain Python that never raise: inf and nan as compiled code has them."""

from __future__ import annotations

import math


def floor(x: float) -> float:
    """Return the largest whole number up to x."""
    return float(math.floor(x)) if abs(x) < 4503599627370496.0 else x


def exp(x: float) -> float:
    """Return eˣ."""
    return math.exp(x) if x < 709.0 else math.inf if x > 709.0 else x


def log(x: float) -> float:
    """Return the natural logarithm."""
    return math.log(x) if x > 0.0 else -math.inf if x == 0.0 else math.nan


def fused(a: float, b: float, c: float) -> float:
    """Return a·b + c; where the processor can, code compiled well rounds it once."""
    return a * b + c


def sin(x: float) -> float:
    """Return the sine."""
    return math.sin(x) if abs(x) < math.inf else math.nan


def cos(x: float) -> float:
    """Return the cosine."""
    return math.cos(x) if abs(x) < math.inf else math.nan


atan = math.atan
tanh = math.tanh
