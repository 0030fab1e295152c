"""The range of a slider: where a value stands on it, steps of round numbers, limits as a text."""

from __future__ import annotations

from math import floor, isfinite, log10

from desire_tui.engine.data_classes import dataclass

STEPS = 100
LOG_STEPS = 50
"""Steps of a logarithmic range for each factor of ten."""
_DECADE = 10.0


@dataclass(frozen=True, slots=True)
class SliderScale:
    """`low … high`, linear or logarithmic."""

    low: float
    high: float
    is_log: bool = False

    @classmethod
    def around(cls, value: float) -> SliderScale:
        """Return 0 … twice the value, or −1 … 1 for 0."""
        if value > 0:
            return cls(0.0, 2 * value)
        span = abs(value) or 1.0
        return cls(value - span, value + span)

    def part(self, value: float) -> float:
        """Return where a value stands, 0 … 1."""
        if self.is_log:
            where = log10(max(value, self.low) / self.low) / log10(self.high / self.low)
        else:
            where = (value - self.low) / ((self.high - self.low) or 1.0)
        return min(max(where, 0.0), 1.0)

    def at(self, part: float, cells: int) -> float:
        """Return the round number that stands at a part of the range, drawn in so many cells."""
        part = min(max(part, 0.0), 1.0)
        if part in (0.0, 1.0):
            return self.high if part else self.low
        if self.is_log:
            return float(f"{self.low * (self.high / self.low) ** part:.3g}")
        return _rounded(self.low + part * (self.high - self.low), _round_step((self.high - self.low) / cells))

    def stepped(self, value: float, steps: int) -> float:
        """Return the value so many steps further; past an end too."""
        if self.is_log:
            return float(f"{value * _DECADE ** (steps / LOG_STEPS):.4g}")
        step = _round_step((self.high - self.low) / STEPS)
        moved = _rounded(value + steps * step, step)
        return moved if moved != value else value + steps * step

    def holding(self, value: float) -> SliderScale:
        """Return the range, wide enough for a value."""
        if self.low <= value <= self.high or (self.is_log and value <= 0):
            return self
        return SliderScale(min(self.low, value), max(self.high, value), self.is_log)

    def widened(self, factor: float, value: float) -> SliderScale:
        """Return a range so many times as wide around a value."""
        if self.is_log:
            ratio = (self.high / self.low) ** (factor / 2)
            return SliderScale(value / ratio, value * ratio, is_log=True)
        half = (self.high - self.low) / 2 * factor
        return SliderScale(value - half, value + half)

    def toggled(self, value: float) -> SliderScale | None:
        """Return the logarithmic range for a linear one, and back; None for values that have no logarithm."""
        if self.is_log:
            return SliderScale(self.low, self.high)
        if value <= 0:
            return None
        low = self.low if self.low > 0 else value / _DECADE
        return SliderScale(low, max(self.high, low * _DECADE), is_log=True)

    def typed(self, text: str, value: float) -> tuple[float, SliderScale] | None:
        """Read `0.3`, `0 … 2` or `0.3 in 0 … 2` (also `0 2`); None if that is neither."""
        words = text.replace("…", " ").replace("..", " ").replace("in", " ").replace(",", " ").split()
        try:
            numbers = [float(word) for word in words]
        except ValueError:
            return None
        if not numbers or len(numbers) > 3 or not all(map(isfinite, numbers)):
            return None
        if len(numbers) == 1:
            return numbers[0], self.holding(numbers[0])
        low, high = sorted(numbers[-2:])
        if low == high or (self.is_log and low <= 0):
            return None
        if len(numbers) == 2:
            return min(max(value, low), high), SliderScale(low, high, self.is_log)
        return numbers[0], SliderScale(low, high, self.is_log).holding(numbers[0])


def _round_step(step: float) -> float:
    """Return 1, 2 or 5 times a power of ten, near to a step."""
    if not step or not isfinite(step):
        return 1.0
    power = 10.0 ** floor(log10(abs(step)))
    return min((power, 2 * power, 5 * power, 10 * power), key=lambda known: abs(known - abs(step)))


def _rounded(value: float, step: float) -> float:
    return float(f"{round(value / step) * step:.12g}")
