"""Names and numbers of a program as symbols of mathematics."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

_GREEK = frozenset(
    """
    alpha beta gamma delta epsilon zeta eta theta iota kappa lambda mu nu xi pi rho sigma tau upsilon phi chi
    psi omega Gamma Delta Theta Lambda Xi Pi Sigma Upsilon Phi Psi Omega
    """.split()  # noqa: SIM905 - a list of words reads better than a wall of quotes
)
_OTHER = {"epsilon": r"\varepsilon", "PI": r"\pi"}
_INDEXED = re.compile(r"([A-Za-z]+)([0-9]+)")


class Symbols:
    """Turns names into symbols. `names`: those of the program, among which `xdot` is the dotted `x`."""

    def __init__(self, names: Collection[str]) -> None:
        self._names = names

    def symbol(self, name: str, subscripts: Sequence[str] = (), *, bold: bool = False) -> str:
        r"""Return a name as a symbol: `k_off` → `k_{\mathrm{off}}`, `alpha2` → `\alpha_{2}`; arrays are bold.

        `subscripts` are LaTeX already: `x1[i]` → `x_{1,i}`.
        """
        head, *marks = [part for part in name.replace("$", "").split("_") if part] or ["x"]
        if (indexed := _INDEXED.fullmatch(head)) is not None:
            head, marks = indexed[1], [indexed[2], *marks]
        dotted = head.endswith("dot") and head[:-3] in self._names
        base = _letter(head[:-3] if dotted else head, bold=bold)
        base = rf"\dot{{{base}}}" if dotted else base
        below = ",".join([*map(_mark, marks), *subscripts])
        return f"{base}_{{{below}}}" if below else base


def _letter(name: str, *, bold: bool) -> str:
    if name in _GREEK or name in _OTHER:
        letter = _OTHER.get(name, f"\\{name}")
        return rf"\boldsymbol{{{letter}}}" if bold else letter
    if bold:
        return rf"\mathbf{{{name}}}"
    return name if len(name) == 1 else rf"\mathrm{{{name}}}"


def _mark(mark: str) -> str:
    return mark if mark.isdigit() or len(mark) == 1 else rf"\mathrm{{{mark}}}"


_LARGE = 1e7
"""From here on numbers have a power of ten."""
COMMA = r",\, "
"""Between arguments."""

_SPECIAL = {
    "\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}",
    **{char: f"\\{char}" for char in "#$%&_{}"},
}  # fmt: skip


def escaped(text: str) -> str:
    """Return a text as LaTeX shows it."""
    return "".join(_SPECIAL.get(char, char) for char in text)


def number(value: float) -> str:
    r"""Return a number: `25`, `0.001`, `1.35 \times 10^{8}`."""
    if value != value or value in (float("inf"), float("-inf")):  # noqa: PLR0124 - nan alone differs from itself
        return r"\text{undefined}" if value != value else rf"{'-' if value < 0 else ''}\infty"  # noqa: PLR0124
    text = f"{value:.12g}"
    if abs(value) >= _LARGE and "e" not in text:
        text = re.sub(r"\.?0*e\+", "e", f"{value:.11e}")
    mantissa, _, exponent = text.partition("e")
    if not exponent:
        return text
    power = f"10^{{{int(exponent)}}}"
    return power if mantissa == "1" else f"{mantissa} \\times {power}"
