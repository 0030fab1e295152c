"""The words of XPPAUT's expressions, and what Desire says for them."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from desire_tui.convert.expressions import Binary, Call, Expression, Not, Number, Relation

if TYPE_CHECKING:
    from collections.abc import Callable

_SAME = frozenset({
    "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "exp", "abs", "sqrt", "ceil",
})  # fmt: skip
_RENAMED = {"ln": "ln", "log": "ln", "log10": "log", "flr": "floor", "sign": "sgn"}
_TWO = frozenset({"atan2", "max", "min", "mod"})
FUNCTIONS = frozenset({*_SAME, *_RENAMED.values(), *_TWO, "ran", "gauss"})
"""Functions of Desire's that come out."""
BUILT_IN = frozenset({
    *_SAME, *_RENAMED, *_TWO,
    "heav", "ran", "normal", "not", "delay", "del_shft", "shift", "sum", "if", "then", "else",
    "of", "t", "pi", "besselj", "bessely", "besseli", "erf", "erfc", "lgamma", "poisson", "hom_bcs", "int",
})  # fmt: skip
"""XPPAUT's own words in expressions."""
LINEAR = re.compile(r"([a-z_]\w*)\s*=\s*(conv|sparse|mmult)\s*\(([^()]*)\)\s*\Z", re.IGNORECASE | re.ASCII)
"""`special` lines whose function is linear: a name, the function, its arguments."""
MISSING = {
    "besselj": "Desire has no Bessel functions", "bessely": "Desire has no Bessel functions",
    "besseli": "Desire has no Bessel functions", "erf": "Desire has no error function",
    "erfc": "Desire has no error function", "lgamma": "Desire has no gamma function",
    "poisson": "Desire draws no Poisson numbers", "hom_bcs": "it belongs to AUTO's homoclinic orbits",
    "int": "Volterra integrals are not solved here",
}  # fmt: skip
"""Functions without a counterpart, with the reason."""


class NotConvertibleError(Exception):
    """An expression that cannot be read or said otherwise: the reason."""


def _fixed(count: int) -> Callable[[str, tuple[Expression, ...]], None]:
    def check(name: str, arguments: tuple[Expression, ...]) -> None:
        if len(arguments) != count:
            raise NotConvertibleError(f"'{name}' takes {count} argument(s)")

    return check


_ONE_ARGUMENT, _TWO_ARGUMENTS = _fixed(1), _fixed(2)


def called(name: str, arguments: tuple[Expression, ...]) -> Expression:
    """Return a call by Desire's functions; of what is no word of XPPAUT, a call of the model's own."""
    if name in _SAME or name in _RENAMED:
        _ONE_ARGUMENT(name, arguments)
        return Call(_RENAMED.get(name, name), arguments)
    if name in _TWO:
        _TWO_ARGUMENTS(name, arguments)
        return Call(name, arguments)
    match name:
        case "heav":  # 1 at 0, where Desire's function of the same name is 0
            _ONE_ARGUMENT(name, arguments)
            return Relation(">=", arguments[0], Number(0.0))
        case "not":
            _ONE_ARGUMENT(name, arguments)
            return Not(arguments[0])
        case "ran":  # within 0 and its argument; Desire's within -1 and 1
            _ONE_ARGUMENT(name, arguments)
            half = Binary("/", arguments[0], Number(2.0))
            return Binary("*", half, Binary("+", Number(1.0), Call("ran", ())))
        case "normal":  # mean and standard deviation
            _TWO_ARGUMENTS(name, arguments)
            deviation = Binary("*", arguments[1], Call("gauss", (Number(0.0),)))
            return Binary("+", arguments[0], deviation)
        case _:
            return Call(name, arguments)
