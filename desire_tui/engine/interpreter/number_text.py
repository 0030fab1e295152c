"""Numbers and arrays as text, in the exact formats of `write` and `dump`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.values import Kind
from desire_tui.engine.whole_numbers import WHOLE_MOST

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from desire_tui.engine.values import Quantity, Values

_PER_LINE = 5
_PIECE = 100
"""Elements toggled into text at a time, so that a huge array needs no memory and can be broken off."""


def scalar_text(value: complex, kind: Kind) -> str:
    """Return a value as `write` shows it: C's `%g`, `%d` for INTEGER, `a + j*( b)` for COMPLEX."""
    if kind is Kind.COMPLEX:
        return f"{_g(value.real)} + j*( {_g(value.imag)})"
    number = value.real
    if kind is Kind.INTEGER and abs(number) <= WHOLE_MOST:  # beyond, the last digits would be invented
        return f"{number:.0f}"
    return _g(number)


def raw_text(value: complex, kind: Kind) -> str:
    """Return a value with all its digits, for a program to read."""
    if kind is Kind.COMPLEX:
        return f"[{raw_text(value.real, Kind.REAL)},{raw_text(value.imag, Kind.REAL)}]"
    number = value.real
    return f"{number:.0f}" if number.is_integer() and abs(number) < 1e15 else repr(number)


def _g(value: float) -> str:
    return "%g" % value  # noqa: UP031 - C's own format


def array_text(values: Values, quantity: Quantity, name: str) -> Iterator[str]:
    """Yield the lines that show an array, each with its line end: a row begins one, an empty one ends it."""
    size = ",".join(map(str, quantity.shape))
    blanks = "  " if quantity.kind is Kind.INTEGER else " "
    yield f"\n{name}[{size}]  : {quantity.kind.name} ARRAY{blanks}(in ROW major sequence)\n"
    row = quantity.shape[-1]
    ending = "\n\n" if len(quantity.shape) > 1 else "\n"
    for start in range(0, quantity.size, row):
        for first in range(start, start + row, _PER_LINE):
            numbers = elements(values, quantity, first, min(_PER_LINE, start + row - first))
            is_last = first + _PER_LINE >= start + row
            yield "".join(_element_text(v, quantity.kind) for v in numbers) + (ending if is_last else "\n")


def raw_array_text(values: Values, quantity: Quantity) -> Iterator[str]:
    """Yield an array's values separated by tabs: vectors in one line, others one line for each row."""
    row = quantity.shape[-1]
    for first in range(0, quantity.size, row):
        for piece in range(first, first + row, _PIECE):
            numbers = elements(values, quantity, piece, min(_PIECE, first + row - piece))
            ending = "\t" if piece + _PIECE < first + row else "\n"
            yield "\t".join(raw_text(v, quantity.kind) for v in numbers) + ending


def elements(values: Values, quantity: Quantity, first: int, count: int) -> Sequence[complex]:
    """Return some of an array's numbers, counted from 0 in row-major order."""
    last = min(first + count, quantity.size)
    if quantity.kind is Kind.COMPLEX:
        numbers = values.cells[quantity.slot + 2 * first : quantity.slot + 2 * last]
        return [complex(re, im) for re, im in zip(numbers[::2], numbers[1::2], strict=True)]
    return values.cells[quantity.slot + first : quantity.slot + last].tolist()


def _element_text(value: complex, kind: Kind) -> str:
    if kind is Kind.COMPLEX:
        return f"{value.real:12.6e} + j*( {value.imag:12.6e})   "
    return f"{value.real:6.0f}   " if kind is Kind.INTEGER else f"{value.real:12.6e}   "


def octal(value: float) -> str:
    """Return a whole number in octal; negative ones in 16 bits, as they are written."""
    return f"{_bits(value):o}"


def hexadecimal(value: float) -> str:
    """Return a whole number in hexadecimal; negative ones in 16 bits."""
    return f"{_bits(value):x}"


def _bits(value: float) -> int:
    whole = int(value)
    return whole if whole >= 0 else whole & (0xFFFF if whole >= -0x8000 else 0xFFFFFFFFFFFFFFFF)
