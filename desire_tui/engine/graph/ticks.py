"""Round numbers along an axis: where ticks stand and what is written at them."""

from __future__ import annotations

from itertools import pairwise
from math import ceil, floor, isfinite, log10

_STEPS = (1.0, 2.0, 2.5, 5.0)
_WANTED = 6
_MOST = 7
_NEAR = 1e-6
"""In steps: a limit so close to a multiple is one."""
_FIXED_LEAST, _FIXED_MOST = 1e-4, 1e5
"""Numbers between these are written without an exponent."""


def round_ticks(low: float, high: float, most: int = _MOST) -> tuple[float, ...]:
    """Return 5 to 7 round numbers within `low … high`, fewer where only `most` have room.

    Multiples of 1, 2, 2.5 or 5 times a power of ten. Of steps that fit, one with ticks at both ends wins
    over one with a better number of ticks. None where the limits are no numbers or there is no room.
    """
    if not (isfinite(low) and isfinite(high) and isfinite(high - low)) or low >= high or most < 1:
        return ()
    best: tuple[float, float] | None = None
    first = floor(log10(high - low)) - 2
    for power in range(first, first + 4):
        for digit in _STEPS:
            step = digit * 10.0**power
            if not step:
                continue
            count = floor(high / step + _NEAR) - ceil(low / step - _NEAR) + 1
            if not 1 <= count <= min(most, _MOST):
                continue
            ends = sum(abs(v / step - round(v / step)) < _NEAR for v in (low, high))
            score = abs(count - min(_WANTED, most)) - 0.75 * ends + (0.25 if digit == _STEPS[2] else 0.0)
            if best is None or score < best[0]:
                best = score, step
    if best is None:
        return ()
    step = best[1]
    numbers = range(ceil(low / step - _NEAR), floor(high / step + _NEAR) + 1)
    return tuple(min(max(n * step, low), high) for n in numbers)


def minor_ticks(ticks: tuple[float, ...], low: float, high: float, most: int) -> tuple[float, ...]:
    """Return numbers between the ticks and to the ends, at most `most`: fifths, quarters or halves."""
    if len(ticks) < 2:
        return ()
    step = ticks[1] - ticks[0]
    digit = round(step / 10.0 ** floor(log10(step) + _NEAR), 3)
    for parts in (4, 2) if digit == 2 else (5,) if digit in (2.5, 5) else (5, 2):
        small = step / parts
        first, last = ceil((low - ticks[0]) / small - _NEAR), floor((high - ticks[0]) / small + _NEAR)
        numbers = [ticks[0] + n * small for n in range(first, last + 1) if n % parts]
        if len(numbers) <= most:
            return tuple(numbers)
    return ()


def rounded_limits(low: float, high: float) -> tuple[float, float]:
    """Return limits at round numbers that hold `low … high`.

    They begin or end at 0 where the values are all of one sign and 0 is not far; a constant stands in the
    middle.
    """
    if low >= 0 and low <= high / 2:
        low = 0.0
    elif high <= 0 and high >= low / 2:
        high = 0.0
    if not high > low:
        room = abs(high) / 10 or 1.0
        low, high = low - room, high + room
    width = high / _WANTED - low / _WANTED
    power = 10.0 ** floor(log10(width)) if width else 0.0
    if not power:
        return low, high
    steps = (digit * power for digit in (*_STEPS, 10.0))
    step = next((step for step in steps if step >= width), 10 * power)
    bottom, top = floor(low / step + _NEAR) * step, ceil(high / step - _NEAR) * step
    return (bottom, top) if isfinite(bottom) and isfinite(top) else (low, high)


def log_limits(low: float, high: float) -> tuple[float, float]:
    """Return limits, as logarithms like the values, at powers of ten; at round numbers within one of them."""
    if high - low >= 1:
        return float(floor(low + _NEAR)), float(ceil(high - _NEAR))
    bottom, top = rounded_limits(10.0**low, 10.0**high)
    if bottom > 0:
        return log10(bottom), log10(top)
    return float(floor(low + _NEAR)), float(ceil(high - _NEAR))


def log_ticks(low: float, high: float, most: int = _MOST) -> tuple[tuple[float, ...], tuple[str, ...]]:
    """Return ticks of a logarithmic axis, given by the logarithms of its limits, and what is written at them.

    Powers of ten; between few of them also 2 and 5 times those, or round numbers.
    """
    if not (isfinite(low) and isfinite(high)) or low >= high or most < 1:
        return (), ()
    powers = range(ceil(low - _NEAR), floor(high + _NEAR) + 1)
    if len(powers) > 2:
        step = -(-len(powers) // most)
        ticks = [float(power) for power in powers if power % step == 0]
    else:
        numbers = [digit * 10.0**power for power in range(floor(low), ceil(high) + 1) for digit in (1, 2, 5)]
        ticks = [log10(number) for number in numbers if low - _NEAR <= log10(number) <= high + _NEAR]
        if len(ticks) > most:
            ticks = [float(power) for power in powers]
        if len(ticks) < 2:
            ticks = [log10(number) for number in round_ticks(10.0**low, 10.0**high, most) if number > 0]
    return tuple(ticks), tuple(tick_label(float(f"{10.0**tick:.6g}")) for tick in ticks)


def minor_log_ticks(low: float, high: float, most: int) -> tuple[float, ...]:
    """Return the places of 2 … 9 times powers of ten, at most `most`; else of the powers themselves."""
    powers = range(floor(low), ceil(high) + 1)
    for digits in (range(2, 10), range(1, 2)):
        places = [power + log10(digit) for power in powers for digit in digits]
        places = [place for place in places if low <= place <= high]
        if len(places) <= most:
            return tuple(places)
    return ()


def tick_labels(ticks: tuple[float, ...]) -> tuple[str, ...]:
    """Return the ticks as short texts that differ."""
    if not ticks:
        return ()
    largest = max(abs(tick) for tick in ticks)
    step = min((b - a for a, b in pairwise(ticks)), default=largest) or largest or 1.0
    # digits from the largest number's first to the step's last; 2.5 has one more
    digits = min(max(ceil(log10(largest / step) - _NEAR) + 2 if largest else 1, 3), 15)
    small = 0.0 < largest < _FIXED_LEAST or largest >= _FIXED_MOST
    return tuple(
        tick_label(0.0 if abs(tick) < step / 1e6 else tick, digits)
        if small
        else _trimmed(f"{tick:.{min(max(ceil(-log10(step) - _NEAR) + 1, 0), 15)}f}")
        for tick in ticks
    )


def _trimmed(text: str) -> str:
    trimmed = text.rstrip("0").rstrip(".") if "." in text else text
    return "0" if trimmed in ("-0", "") else trimmed


def tick_label(value: float, digits: int = 5) -> str:
    """Return a short number: at most so many significant digits."""
    mantissa, e, exponent = f"{value + 0.0:.{digits}g}".partition("e")
    return f"{mantissa}e{int(exponent)}" if e else mantissa
