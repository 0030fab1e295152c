"""The sequence behind `ran()` and `gauss()`: its constants and its arithmetic (language.md 4.1).

X ← (MULTIPLIER·X + INCREMENT) mod 2⁴⁸ and u = X / 2⁴⁸, as POSIX's drand48. `ran()` is 2u − 1; `gauss(0)` is
sqrt(RADIUS_FACTOR · ln u₁) · cos(TWO_PI · u₂) (Box and Muller), the radius drawn first. Scripts, the
reference back end and compiled code each write this down in their own way, from the constants below.
"""

from __future__ import annotations

from math import pi

MULTIPLIER, INCREMENT, BITS = 0x5DEECE66D, 11, 48
MASK = (1 << BITS) - 1
SCALE = 2.0**-BITS
RADIUS_FACTOR, TWO_PI = -2.0, 2.0 * pi

DRAWS = {"ran": 1, "gauss": 2}
"""The functions that draw, and how many numbers one call takes from the sequence."""

_SEED_TAIL = 0x330E
_INVERSE = pow(MULTIPLIER, -1, 1 << BITS)


def seeded(n: float) -> int:
    """Return the state that `SEED n` sets; n is truncated."""
    return ((int(n) << 16) + _SEED_TAIL) & MASK


def jump(count: int) -> tuple[int, int]:
    """Return (a, c) so that `count` steps of the sequence (backwards if negative) are X ← a·X + c mod 2⁴⁸."""
    step = (MULTIPLIER, INCREMENT) if count >= 0 else (_INVERSE, -_INVERSE * INCREMENT & MASK)
    total = (1, 0)
    for bit in f"{abs(count):b}":
        a, c = total
        total = (a * a & MASK, (a * c + c) & MASK)
        if bit == "1":
            a, c = total
            total = (a * step[0] & MASK, (a * step[1] + c) & MASK)
    return total
