"""sin and cos of many numbers: the operations of glibc's (2.28 and later; LICENSES/GLIBC.txt).

Its results are up to 0.55 units of the last place off, so that no bound would tell which way 1 to 2 % of them
are rounded. Operation by operation, then: ±(a + d) is left of |x| (`quarter_turns`); a = k/128 + r. With the
sine S and the cosine C of k/128 from a table, each as two doubles,

    sin(a + d) = S + (Sl + s·Cl - S·c + C·s),  s = sin(r + d),  c = 1 - cos(r + d)

and below 0.126 Taylor's series (S. Gal and B. Bachelis, "An accurate elementary mathematical library for the
IEEE floating point standard", ACM TOMS 17, 1991). cos is the same with C for S and -S for C. Whether the C
library at hand does this, with fused multiplication and addition where GCC puts it, `compiled` finds out.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.codegen.exact_functions.angles import ROWS, sines_and_cosines
from desire_tui.engine.codegen.exact_functions.lookups import loaded_rows
from desire_tui.engine.codegen.exact_functions.pairs import Pairs
from desire_tui.engine.codegen.exact_functions.quarter_turns import (
    Rest,
    is_large,
    reduced,
    sign_of,
    untouched,
    with_sign,
)
from desire_tui.engine.codegen.exact_functions.rounding_test import Result

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.codegen.ir.lanes import Lanes

_GRID = 1.5 * 2.0**45
"""Added and taken away: rounds to multiples of 1/128, whose number its last bits show."""
_TAYLOR_BELOW = 0.126
_TAYLOR = tuple(
    map(
        float.fromhex,
        (
            "-0x1.5555555555555p-3",
            "0x1.1111111110ecep-7",
            "-0x1.a01a019db08b8p-13",
            "0x1.71de27b9a7ed9p-19",
            "-0x1.addffc2fcdf59p-26",
        ),
    )
)
"""(sin a - a)/a³ in powers of a²: glibc's coefficients."""
_SINE = tuple(map(float.fromhex, ("-0x1.5555555555515p-3", "0x1.11110e829872fp-7")))
"""(sin r - r)/r³ in powers of r², |r| ≤ 1/256."""
_COSINE = tuple(map(float.fromhex, ("0x1p-1", "-0x1.5555555555535p-5", "0x1.6c16bedd9e239p-10")))
"""(1 - cos r)/r²."""


class _Row(NamedTuple):
    """Of the function wanted at k/128: value and what it lacks, and the derivative's."""

    own: str
    own_low: str
    other: str
    other_low: str


def sine_and_cosine(lanes: Lanes, names: Sequence[str]) -> list[Result]:
    """Return functions of the argument `%x`: one of `sin` and `cos`, or both, in this order.

    Where nothing is taken away from any element, all that follows from that is left out.
    """
    text, size = lanes.text, lanes.intrinsic("fabs", "%x")
    text.branch(lanes.any(is_large(lanes, size)), "reduce", "small")
    ends = []
    for label, rest_of in (("small", untouched), ("reduce", reduced)):
        text.begin(label)
        rest = rest_of(lanes, size)
        values = SineAndCosine(lanes, names, rest).values()
        ends.append((text.label, [*values, rest.unknown]))
        text.jump("both")
    text.begin("both")
    (one, own), (other, others) = ends
    kinds = [lanes.kind] * len(names) + [lanes.integers]
    *values, unknown = (
        text.op(f"phi {kind} [ {a}, %{one} ], [ {b}, %{other} ]")
        for kind, a, b in zip(kinds, own, others, strict=True)
    )
    return [Result(value, unknown) for value in values]


class SineAndCosine:
    """Functions of the argument `%x`, of whose size `rest` is left."""

    def __init__(self, lanes: Lanes, names: Sequence[str], rest: Rest) -> None:
        self.lanes, self._fma, self._names, self._rest = lanes, Pairs(lanes).fma, names, rest
        text, integers = lanes.text, lanes.integers
        shifted = lanes.add(rest.size, lanes.const(_GRID))
        self._r = lanes.sub(rest.size, lanes.sub(shifted, lanes.const(_GRID)))
        place = text.op(f"bitcast {lanes.kind} {shifted} to {integers}")
        place = text.op(f"and {integers} {place}, {lanes.integer(ROWS - 1)}")
        odd = rest.turns
        if names == ("cos",):  # of π/2 one more: then it is the sine
            odd = text.op(f"xor {integers} {odd}, {lanes.integer(1)}")
        odd = text.op(f"and {integers} {odd}, {lanes.integer(1)}")
        self._odd = text.op(f"icmp ne {integers} {odd}, {lanes.integer(0)}")
        if len(names) == 1:
            second_half = text.op(f"mul {integers} {odd}, {lanes.integer(ROWS)}")
            place = text.op(f"or {integers} {place}, {second_half}")
        self._row = _Row(*loaded_rows(lanes, place, _rows()))

    def values(self) -> list[str]:
        """Return what was asked for, in the order of the names."""
        lanes = self.lanes
        if len(self._names) == 1:
            values = dict.fromkeys(self._names, self._one())
        else:
            sine, cosine = self._both()
            values = {
                "sin": lanes.choose(self._odd, cosine, sine),
                "cos": lanes.choose(self._odd, sine, cosine),
            }
        return [self._signed(name, values[name]) for name in self._names]

    def _one(self) -> str:
        """Return sin(a + d) for even, cos(a + d) for odd elements, whose row has the cosine as its own."""
        lanes, fma, odd = self.lanes, self._fma, self._odd
        row, d = self._row, self._rest.low
        r = lanes.choose(odd, lanes.add(self._r, d), self._r)
        square, s, c = self._polynomials(r)
        s = fma(lanes.mul(r, square), s, lanes.choose(odd, r, d))
        s = lanes.choose(odd, s, lanes.add(r, s))
        value = self._with_series(self._sum(row, s, self._one_less_cosine(r, square, c)), even_only=True)
        integers = lanes.integers
        sign = f"{integers} {lanes.integer(0)}, {integers} {self._rest.sign}"
        return with_sign(lanes, value, lanes.text.op(f"select {lanes.flags} {odd}, {sign}"))

    def _both(self) -> tuple[str, str]:
        """Return ± sin(a + d) and cos(a + d)."""
        lanes, fma, r, row = self.lanes, self._fma, self._r, self._row
        square, s, c = self._polynomials(r)
        s = lanes.add(r, fma(lanes.mul(r, square), s, self._rest.low))
        sine = self._sum(row, s, self._one_less_cosine(r, square, c))
        r = lanes.add(r, self._rest.low)
        square, s, c = self._polynomials(r)
        turned = _Row(row.other, row.other_low, lanes.neg(row.own), lanes.neg(row.own_low))
        cosine = self._sum(turned, fma(lanes.mul(r, square), s, r), lanes.mul(square, c))
        return with_sign(lanes, self._with_series(sine), self._rest.sign), cosine

    def _polynomials(self, r: str) -> tuple[str, str, str]:
        """Return r², (sin r - r)/r³ and (1 - cos r)/r²."""
        lanes, fma, const = self.lanes, self._fma, self.lanes.const
        square = lanes.mul(r, r)
        sine = fma(square, const(_SINE[1]), const(_SINE[0]))
        cosine = fma(square, fma(square, const(_COSINE[2]), const(_COSINE[1])), const(_COSINE[0]))
        return square, sine, cosine

    def _one_less_cosine(self, r: str, square: str, c: str) -> str:
        """Return 1 - cos(r + d) for even, 1 - cos r for odd elements of one function."""
        lanes, d = self.lanes, self._rest.low
        if self._rest.is_whole:
            return lanes.mul(square, c)
        if len(self._names) == 1:
            d = lanes.choose(self._odd, lanes.const(0.0), d)
        return self._two_products(r, d, square, c)

    def _two_products(self, a: str, b: str, c: str, d: str) -> str:
        """Return a·b + c·d: GCC fuses the first product with the sum."""
        return self._fma(a, b, self.lanes.mul(c, d))

    def _sum(self, row: _Row, s: str, c: str) -> str:
        fma = self._fma
        correction = fma(self.lanes.neg(row.own), c, fma(s, row.other_low, row.own_low))
        return self.lanes.add(row.own, fma(row.other, s, correction))

    def _with_series(self, sine: str, *, even_only: bool = False) -> str:
        """Return Taylor's sum instead where a is small; it is jumped over where none is."""
        lanes, text = self.lanes, self.lanes.text
        small = lanes.compare("olt", self._rest.size, lanes.const(_TAYLOR_BELOW))
        if even_only:
            even = text.op(f"xor {lanes.flags} {self._odd}, splat (i1 true)")
            small = text.op(f"and {lanes.flags} {small}, {even}")
        before, series, summed = text.label, f"{text.label}.series", f"{text.label}.summed"
        text.branch(lanes.any(small), series, summed)
        text.begin(series)
        chosen = lanes.choose(small, self._series(), sine)
        text.jump(summed)
        text.begin(summed)
        return text.op(f"phi {lanes.kind} [ {sine}, %{before} ], [ {chosen}, %{series} ]")

    def _series(self) -> str:
        """Return sin(a + d)."""
        lanes, fma, const = self.lanes, self._fma, self.lanes.const
        a, d = self._rest.size, self._rest.low
        square = lanes.mul(a, a)
        total = const(_TAYLOR[-1])
        for coefficient in _TAYLOR[-2::-1]:
            total = fma(total, square, const(coefficient))
        total = fma(total, a, lanes.neg(lanes.mul(const(0.5), d)))
        return lanes.add(a, fma(total, square, d))

    def _signed(self, name: str, value: str) -> str:
        """Return a result from the one for |x| less all multiples."""
        text, lanes, turns = self.lanes.text, self.lanes, self._rest.turns
        if name == "cos":
            turns = text.op(f"add {lanes.integers} {turns}, {lanes.integer(1)}")
        flips = text.op(f"shl {lanes.integers} {turns}, {lanes.integer(62)}")
        if name == "sin":
            argument = text.op(f"bitcast {lanes.kind} %x to {lanes.integers}")
            flips = text.op(f"xor {lanes.integers} {flips}, {argument}")
        flips = text.op(f"bitcast {lanes.integers} {flips} to {lanes.kind}")
        return with_sign(lanes, value, sign_of(lanes, flips))


def _rows() -> list[tuple[float, float, float, float]]:
    """Return the table: sine and cosine of k/128, then the cosine and its derivative."""
    values = sines_and_cosines()
    sines = [(*sine, *cosine) for sine, cosine in values]
    return sines + [(*cosine, -sine[0], -sine[1]) for sine, cosine in values]
