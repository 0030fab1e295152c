"""The function library: one table that interpreter, lowering, completion and help pages share.

`LIBRARY[name]` says how a function is called, where it may stand and what it is worth for Python floats
(language.md 4.1; book, section 4.2.1 and Tables 4.1-4.3). Real values raise Python's own ValueError,
OverflowError or ZeroDivisionError for arguments outside their domain; `domain_error` is the message key that
a ValueError stands for.
"""
# ruff: noqa: FURB136 - calling max() takes three times as long as comparing, and scripts call these in loops

from __future__ import annotations

import math
from bisect import bisect_right
from cmath import exp as _cexp
from cmath import phase
from typing import TYPE_CHECKING, Literal

from desire_tui.engine.data_classes import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence


def _lim(x: float) -> float:
    return 0.0 if x <= 0.0 else x


def _sat(x: float) -> float:
    return 1.0 if x > 1.0 else -1.0 if x < -1.0 else x


def _sat_unit(x: float) -> float:
    return 1.0 if x > 1.0 else 0.0 if x <= 0.0 else x


def _deadz(x: float) -> float:
    return x - _sat(x)


def _deadc(x: float) -> float:
    return 1.0 if x > 1.0 else -1.0 if x < -1.0 else 0.0 if x <= 1.0 else x


def _swtch(x: float) -> float:
    return 1.0 if x > 0.0 else 0.0 if x <= 0.0 else x


def _sgn(x: float) -> float:
    return 1.0 if x > 0.0 else -1.0 if x < 0.0 else x + 0.0


def _comp(x: float, minus: float, plus: float) -> float:
    return plus if x > 0.0 else minus if x <= 0.0 else x


def _rect(x: float) -> float:
    return 1.0 if -1.0 < x < 1.0 else x if x != x else 0.0  # noqa: PLR0124 - nan


def _tri(x: float) -> float:
    return 1.0 - abs(x)


def _sinc(x: float) -> float:
    return math.sin(x) / x if x else 1.0


def _sigmoid(x: float) -> float:
    try:
        return 1.0 / (1.0 + math.exp(-x))
    except OverflowError:
        return 0.0  # the limit; compiled code gets it from 1/(1 + inf)


def _sigmoid_rational(x: float) -> float:
    if x <= 0.0:
        return 0.0
    square = x * x
    return 1.0 if square == math.inf else square / (1.0 + square)


def rounded(x: float) -> float:
    """Nearest whole number, halves away from zero."""
    if not -4503599627370496.0 < x < 4503599627370496.0:  # whole already, or inf, or nan
        return x
    whole = float(int(x))
    return math.copysign(whole + math.copysign(1.0, x) if abs(x - whole) >= 0.5 else whole, x)


def shifted_by(k: float, size: int) -> int:
    """Return by how many places `x{k}` shifts `size` elements: k rounded; all are gone at `size`."""
    return int(rounded(max(-float(size), min(float(size), k))))


def _trnc(x: float) -> float:
    return math.copysign(int(x), x) if abs(x) < 4503599627370496.0 else x


def _floor(x: float) -> float:
    return float(math.floor(x)) if abs(x) < 4503599627370496.0 else x


def _ceil(x: float) -> float:
    return -_floor(-x)


def _mod(x: float, y: float) -> float:
    return x - y * _floor(x / y)


def _max(x: float, y: float) -> float:
    return x if y <= x or x != x else y  # noqa: PLR0124 - nan


def _min(x: float, y: float) -> float:
    return x if y >= x or x != x else y  # noqa: PLR0124 - nan


def _recip(x: float) -> float:
    return 1.0 / x


def integer_power(x: complex, n: int) -> complex:
    """Return x^n by repeated products: binary powering from the top bit, negative n as 1/x^|n|; x^0 is 1."""
    if n == 0:
        return 1.0
    value = x
    for bit in bin(abs(n))[3:]:
        value *= value
        if bit == "1":
            value *= x
    return 1.0 / value if n < 0 else value


def power(x: float, y: float) -> float:
    """Return x^y for a general power: x > 0, or x = 0 with y > 0. ValueError, OverflowError."""
    if x > 0.0:
        return math.pow(x, y)
    if x == 0.0 and y > 0.0:
        return 0.0
    if x != x or y != y:  # noqa: PLR0124 - nan
        return math.nan
    raise ValueError


def func1(x: float, table: Sequence[float]) -> float:
    """Linear interpolation: breakpoints in the table's first half, values in the second; constant outside."""
    if x != x:  # noqa: PLR0124 - nan
        return x
    n = len(table) // 2
    if x <= table[0]:
        return table[n]
    if x >= table[n - 1]:
        return table[2 * n - 1]
    k = bisect_right(table, x, 0, n)
    x0, y0 = table[k - 1], table[n + k - 1]
    return y0 + (table[n + k] - y0) * ((x - x0) / (table[k] - x0))


def func2(x: float, y: float, f: Sequence[float], xs: Sequence[float], ys: Sequence[float]) -> float:
    """Bilinear interpolation of F[n,m] (row-major) over breakpoints X[n], Y[m]; constant outside."""
    if x != x or y != y:  # noqa: PLR0124 - nan
        return math.nan
    i, p = _bracket(x, xs)
    k, q = _bracket(y, ys)
    m = len(ys)
    i2, k2 = min(i + 1, len(xs) - 1), min(k + 1, m - 1)
    lower = f[i * m + k] + (f[i * m + k2] - f[i * m + k]) * q
    upper = f[i2 * m + k] + (f[i2 * m + k2] - f[i2 * m + k]) * q
    return lower + (upper - lower) * p


def _bracket(x: float, points: Sequence[float]) -> tuple[int, float]:
    """Index of the interval that holds x, and x's place in it (0 … 1)."""
    last = len(points) - 1
    if x <= points[0] or last == 0:
        return 0, 0.0
    if x >= points[last]:
        return last, 0.0
    k = bisect_right(points, x) - 1
    return k, (x - points[k]) / (points[k + 1] - points[k])


def _expj(x: complex) -> complex:
    return complex(math.cos(x.real), math.sin(x.real))


def _cexp_of(x: complex) -> complex:
    return _cexp(x) if isinstance(x, complex) else math.exp(x)


Kind = Literal["real", "complex", "random", "table", "time", "choice", "noise", "history"]


@dataclass(frozen=True, slots=True)
class LibraryFunction:
    """One function.

    `parameters` as shown to the user, in brackets what may be left out; `fewest` … `most` arguments; `where`:
    S script, D DYNAMIC, M MATRIX; `kind`: `real`, `complex` (takes COMPLEX arguments; `value` gets complex
    numbers), `random` (draws), `table` (array arguments), `time`, `choice` (real, but a user's FUNCTION of
    that name wins), `noise` and `history` (of segments); `value` is None where more than numbers is needed;
    `gives_complex` marks COMPLEX results.
    """

    name: str
    parameters: str
    fewest: int
    most: int
    help: str
    value: Callable[..., float | complex] | None
    where: str = "SDM"
    kind: Kind = "real"
    gives_complex: bool = False
    domain_error: str = "argument-out-of-domain"


def _one(
    name: str, value: Callable[[float], float], text: str, domain: str = "argument-out-of-domain"
) -> LibraryFunction:
    return LibraryFunction(name, "x", 1, 1, text, value, domain_error=domain)


def _of_complex(
    name: str, value: Callable[[complex], complex], text: str, *, gives: bool = False
) -> LibraryFunction:
    return LibraryFunction(name, "z", 1, 1, text, value, where="S", kind="complex", gives_complex=gives)


_ALL = (
    _one("sin", math.sin, "sine; x in radians"),
    _one("cos", math.cos, "cosine; x in radians"),
    _one("tan", math.tan, "tangent; x in radians"),
    _one("asin", math.asin, "arc sine, −PI/2 … PI/2; x within −1 … 1"),
    _one("acos", math.acos, "arc cosine, 0 … PI; x within −1 … 1"),
    _one("atan", math.atan, "arc tangent, −PI/2 … PI/2"),
    _one("sinh", math.sinh, "hyperbolic sine"),
    _one("cosh", math.cosh, "hyperbolic cosine"),
    _one("tanh", math.tanh, "hyperbolic tangent; a soft limiter"),
    LibraryFunction("exp", "x", 1, 1, "exponential; COMPLEX too in scripts", _cexp_of, kind="complex"),
    _one("sqrt", math.sqrt, "square root; x not negative", "root-of-negative"),
    _one("abs", abs, "absolute value"),
    _one("ln", math.log, "natural logarithm; x positive", "logarithm-argument"),
    _one("log", math.log10, "logarithm to base 10; x positive", "logarithm-argument"),
    LibraryFunction("atan2", "y, x", 2, 2, "angle of the point (x, y), −PI … PI", math.atan2),
    _one("lim", _lim, "simple limiter: x if x > 0, else 0"),
    _one("sat", _sat, "limits x to −1 … 1"),
    _one("SAT", _sat_unit, "limits x to 0 … 1"),
    _one("deadz", _deadz, "dead zone: x − sat(x)"),
    _one("deadc", _deadc, "dead-zone comparator: −1 if x < −1, 1 if x > 1, else 0"),
    _one("swtch", _swtch, "switch: 1 if x > 0, else 0"),
    _one("sgn", _sgn, "sign: −1, 0 or 1"),
    LibraryFunction("comp", "x, minus, plus", 3, 3, "comparator: plus if x > 0, else minus", _comp),
    _one("rect", _rect, "rectangle: 1 if abs(x) < 1, else 0"),
    _one("tri", _tri, "triangle: 1 − abs(x), not clipped"),
    _one("sinc", _sinc, "sin(x)/x, 1 at 0"),
    _one("sigmoid", _sigmoid, "1/(1 + exp(−x))"),
    _one("SIGMOID", _sigmoid_rational, "0 for x ≤ 0, else x²/(1 + x²)"),
    _one("round", rounded, "nearest whole number, halves away from zero"),
    _one("trnc", _trnc, "whole part, toward zero"),
    LibraryFunction("ran", "", 0, 1, "uniform random number in (−1, 1); see SEED", None, kind="random"),
    LibraryFunction("gauss", "0", 0, 1, "normal random number, mean 0, variance 1", None, kind="random"),
    LibraryFunction("tim", "0", 0, 1, "CPU time in seconds", None, where="S", kind="time"),
    LibraryFunction("func1", "x; F", 2, 2, "table function: F holds breakpoints, then values",
                    func1, where="SD", kind="table"),
    LibraryFunction("func2", "x, y; F, X, Y", 5, 5, "bilinear table function of F[n,m] over X[n], Y[m]",
                    func2, where="SD", kind="table"),
    LibraryFunction("recip", "A", 1, 1, "1/A, element by element", _recip),
    LibraryFunction("max", "x, y", 2, 2, "the larger one; a program's own max wins", _max, kind="choice"),
    LibraryFunction("min", "x, y", 2, 2, "the smaller one; a program's own min wins", _min, kind="choice"),
    LibraryFunction("floor", "x", 1, 1, "largest whole number up to x; a program's own floor wins", _floor,
                    kind="choice"),
    LibraryFunction("ceil", "x", 1, 1, "smallest whole number not below x; a program's own ceil wins", _ceil,
                    kind="choice"),
    LibraryFunction("mod", "x, y", 2, 2, "x − y*floor(x/y), with y's sign; a program's own mod wins", _mod,
                    kind="choice"),
    LibraryFunction("heav", "x", 1, 1, "unit step: 1 if x > 0, else 0; a program's own heav wins", _swtch,
                    kind="choice"),
    LibraryFunction("white", "s", 1, 1, "white noise of spectral density s² for d/dt lines, new at each step",
                    None, where="D", kind="noise"),
    LibraryFunction("delay", "x, tau[, h]", 2, 3, "x at t − tau; before the start h(t), or the initial value",
                    None, where="D", kind="history"),
    _of_complex("Re", lambda z: z.real, "real part"),
    _of_complex("Im", lambda z: z.imag, "imaginary part"),
    _of_complex("Cabs", abs, "absolute value of a complex number"),
    _of_complex("Arg", phase, "argument of a complex number, −PI … PI"),
    _of_complex("Conjug", lambda z: z.conjugate(), "conjugate complex number", gives=True),
    _of_complex("expj", _expj, "cos(x) + j*sin(x) of the real part x", gives=True),
)  # fmt: skip

LIBRARY: dict[str, LibraryFunction] = {entry.name: entry for entry in _ALL}
