"""exp of many numbers: the operations of glibc's (2.28 and later), which came from Arm's optimized routines.

See LICENSES/ARM.txt.

x = k·ln 2/128 + r with |r| ≤ ln 2/256, and exp x = 2^(k/128)·exp r = s + s·(t + exp r - 1), where s is the
double next to 2^(k/128) and s·(1 + t) is nearer to it. From |x| = 512 on, where s may be no double, the
library is asked.
"""

from __future__ import annotations

import struct
from fractions import Fraction
from functools import cache
from typing import TYPE_CHECKING

from desire_tui.engine.codegen.exact_functions.constants import ln_2, powers_of_two
from desire_tui.engine.codegen.exact_functions.lookups import loaded_rows
from desire_tui.engine.codegen.exact_functions.pairs import Pairs
from desire_tui.engine.codegen.exact_functions.rounding_test import Result, beyond

if TYPE_CHECKING:
    from desire_tui.engine.codegen.ir.lanes import Lanes

_PARTS_BITS = 7
_PARTS = 1 << _PARTS_BITS
_MOST = 512.0
_MAGIC = 1.5 * 2.0**52
_GRID = 2**44
"""Of ln 2/128, k times are taken away in two parts: the first, a multiple of 1/_GRID, without error."""
_COEFFICIENTS = tuple(
    map(
        float.fromhex,
        ("0x1.ffffffffffdbdp-2", "0x1.555555555543cp-3", "0x1.55555cf172b91p-5", "0x1.1111167a4d017p-7"),
    )
)
"""(exp r - 1 - r)/r² in powers of r."""


def exponential(lanes: Lanes) -> Result:
    """Return exp of `%x`."""
    text, fma, const, integers = lanes.text, Pairs(lanes).fma, lanes.const, lanes.integers
    part = ln_2() / _PARTS
    first = Fraction(round(part * _GRID), _GRID)
    shifted = fma("%x", const(float(1 / part)), const(_MAGIC))
    k = lanes.sub(shifted, const(_MAGIC))
    r = fma(k, const(-float(part - first)), fma(k, const(-float(first)), "%x"))
    bits = text.op(f"bitcast {lanes.kind} {shifted} to {integers}")
    place = text.op(f"and {integers} {bits}, {lanes.integer(_PARTS - 1)}")
    scale, lacks, _, _ = loaded_rows(lanes, place, _rows())
    power = text.op(f"shl {integers} {bits}, {lanes.integer(52 - _PARTS_BITS)}")
    scale = text.op(f"bitcast {lanes.kind} {scale} to {integers}")
    scale = text.op(f"add {integers} {scale}, {power}")
    scale = text.op(f"bitcast {integers} {scale} to {lanes.kind}")
    square = lanes.mul(r, r)
    near, far = (fma(r, const(_COEFFICIENTS[n + 1]), const(_COEFFICIENTS[n])) for n in (0, 2))
    grown = fma(lanes.mul(square, square), far, fma(square, near, lanes.add(lacks, r)))
    return Result(fma(scale, grown, scale), beyond(lanes, lanes.intrinsic("fabs", "%x"), _MOST))


@cache
def _rows() -> list[tuple[float, float, float, float]]:
    """Return for each n the double next to 2^(n/128), less the bits that k adds, and what it lacks."""
    return [_row(n, value) for n, value in enumerate(powers_of_two(_PARTS_BITS))]


def _row(n: int, value: Fraction) -> tuple[float, float, float, float]:
    near = float(value)
    bits = struct.unpack("<Q", struct.pack("<d", near))[0] - (n << (52 - _PARTS_BITS))
    return struct.unpack("<d", struct.pack("<Q", bits))[0], float(value / Fraction(near) - 1), 0.0, 0.0
