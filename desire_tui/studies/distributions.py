"""What is drawn: `normal(40, 4)`, `uniform(-1, 1)`, `lognormal(0, 0.2)`, and scipy.stats' own by their names.

Three have the meaning of everyday language, not scipy's: `uniform(a, b)` is between a and b, `normal(m, s)`
has mean m and standard deviation s, `lognormal(m, s)` is exp of a `normal(m, s)`. All others take scipy's
arguments: `gamma(2, scale=3)`, `randint(1, 7)`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from desire_tui.engine.diagnostics import closest
from desire_tui.studies.texts import number, outside, split, whole

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from desire_tui.studies.texts import Piece

    Floats = NDArray[np.float64]

EXAMPLE = "k=normal(40, 4), x0=uniform(-1, 1), r=lognormal(0, 0.2), g=gamma(2, scale=3)"
_PARAMETERS = {
    "uniform": "from, to",
    "normal": "mean, standard deviation",
    "lognormal": "of the logarithm: mean, deviation",
}


class Distribution:
    """Numbers with a distribution, made from numbers uniform in (0, 1)."""

    def __init__(self, text: str, quantile: Callable[[Floats], Any]) -> None:
        self.text = text
        self._quantile = quantile

    def __repr__(self) -> str:
        return self.text

    def numbers(self, uniform: Floats) -> Floats:
        """Return the numbers below which so much of the distribution lies."""
        return np.asarray(self._quantile(uniform), dtype=np.float64)


def distribution(given: object, name: str = "--sample") -> Distribution:
    """Return a distribution from its text, or from a frozen one of scipy.stats. DesireError 510."""
    if isinstance(given, Distribution):
        return given
    if hasattr(given, "ppf"):
        own = getattr(getattr(given, "dist", None), "name", type(given).__name__)
        arguments = [
            *getattr(given, "args", ()),
            *(f"{k}={v}" for k, v in getattr(given, "kwds", {}).items()),
        ]
        return Distribution(f"{own}({', '.join(map(str, arguments))})", given.ppf)
    return read(whole(str(given), name))


def read(piece: Piece) -> Distribution:
    """Read `normal(40, 4)`. DesireError 510."""
    opening = piece.text.find("(")
    if opening < 1 or not piece.text.endswith(")") or ")" in piece.text[:-1]:
        raise piece.wrong(f"'{piece.text}' is no distribution", f"for instance {EXAMPLE}")
    name = piece.part(0, opening)
    arguments = [part for part in split(piece.part(opening + 1, len(piece.text) - 1)) if part.text]
    own = _OWN.get(name.text)
    if own is None:
        return Distribution(piece.text, _of_scipy(piece, name, arguments))
    if len(arguments) != 2:
        raise piece.wrong(
            f"{name.text} takes 2 numbers, not {len(arguments)}", f"{name.text}({_PARAMETERS[name.text]})"
        )
    first, second = (number(part, f"{name.text}({_PARAMETERS[name.text]})") for part in arguments)
    if name.text == "uniform" and not first < second:
        raise piece.wrong(f"nothing lies between {first:g} and {second:g}", "the smaller one comes first")
    if name.text != "uniform" and not second > 0.0:
        raise arguments[1].wrong(f"a standard deviation of {second:g} is not above 0", "give one that is")
    return Distribution(piece.text, lambda u: own(u, first, second))


def _normal(u: Floats) -> Floats:
    from scipy.special import ndtri

    return np.asarray(ndtri(u))


_OWN: dict[str, Callable[[Floats, float, float], Floats]] = {
    "uniform": lambda u, a, b: a + (b - a) * u,
    "normal": lambda u, m, s: m + s * _normal(u),
    "lognormal": lambda u, m, s: np.exp(m + s * _normal(u)),
}


def _of_scipy(piece: Piece, name: Piece, arguments: list[Piece]) -> Callable[[Floats], Any]:
    from scipy import stats

    kind: Any = getattr(stats, name.text, None)
    if not isinstance(kind, stats.rv_continuous | stats.rv_discrete):
        known = [
            n for n in dir(stats) if isinstance(getattr(stats, n), stats.rv_continuous | stats.rv_discrete)
        ]
        near = closest(name.text, [*_OWN, *known])
        raise name.wrong(
            f"there is no distribution '{name.text}'",
            "uniform, normal, lognormal, or one of scipy.stats",
            close=near,
        )
    plain: list[float] = []
    named: dict[str, float] = {}
    for part in arguments:
        at = next((k for k in outside(part.text) if part.text[k] == "="), None)
        if at is None:
            plain.append(number(part, EXAMPLE))
        else:
            named[part.text[:at].strip()] = number(part.part(at + 1), EXAMPLE)
    takes = ", ".join(
        filter(None, (kind.shapes, "loc, scale" if isinstance(kind, stats.rv_continuous) else "loc"))
    )
    try:
        frozen = kind(*plain, **named)
        middle = float(frozen.ppf(0.5))
    except TypeError:
        raise piece.wrong(f"{name.text} does not take these arguments", f"scipy's are: {takes}") from None
    if np.isnan(middle):
        raise piece.wrong(f"{name.text} is not defined for these numbers", f"scipy's arguments are: {takes}")
    quantile: Callable[[Floats], Any] = frozen.ppf
    return quantile
