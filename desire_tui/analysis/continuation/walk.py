"""The way along a curve: lengths of steps, and the places where a test function changes its sign."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from desire_tui.analysis.continuation.curve import Point, advanced, unit
from desire_tui.engine.data_classes import dataclass, field

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from desire_tui.analysis.continuation.curve import Curve

End = Literal["", "bound", "far", "lost", "closed", "many", "stopped", "hopf", "homoclinic"]

_FIRST, _LEAST, _MOST = 0.01, 1e-7, 0.05
_FINE = 2e-3
"""Steps so short are not halved any more to tell zeros apart."""
_STRAIGHT = 0.97
"""Cosine of the angle by which the tangent may turn in a step."""
_EASY, _HARD = 6, 9
"""Iterations after which a step is made longer, or shorter."""
_LOCATED = 1e-11
_HALVINGS = 60
_TINY = 1e-13
_PARTS = (0.5, 0.45, 0.2, 0.8, 0.05, 0.95)
"""Next to a branch point the equations are nearly singular: other places of a bracket are tried then."""


@dataclass
class Step:
    """A step: the zeros of tests in it in their order, the point at its end, and why the curve ends there."""

    point: Point
    zeros: list[tuple[str, Point]] = field(default_factory=list)
    end: End = ""


def walk(
    curve: Curve,
    first: Point,
    *,
    points_most: int,
    is_far: Callable[[Point], bool],
    step_most: float = _MOST,
) -> Iterator[Step]:
    """Go along a curve from a point, its tangent's way, until it ends; the first point is not repeated."""
    here, length = first, min(_FIRST, step_most)
    travelled = 0.0
    for _ in range(points_most):
        found = _step(curve, here, length)
        if found is None:
            yield Step(here, end="lost")
            return
        ahead, length, zeros = found
        step = Step(ahead)
        for _, name, place in zeros:
            if name in curve.ends:
                step.point, step.end = place, "bound"
                break
            step.zeros.append((name, place))
        if not step.end:
            travelled += length
            if is_far(ahead):
                step.end = "far"
            elif travelled > 4.0 * length and _is_back(curve, first, here, ahead, length):
                step.end = "closed"
        yield step
        if step.end:
            return
        here = curve.adapted(ahead)
        if ahead.iterations <= _EASY:
            size = 1.0 + float(np.sqrt(here.u @ (curve.weights * here.u)))
            length = min(length * 1.4, step_most * size)
        elif ahead.iterations >= _HARD:
            length /= 2.0
    yield Step(here, end="many")


def _step(
    curve: Curve, here: Point, length: float
) -> tuple[Point, float, list[tuple[float, str, Point]]] | None:
    """Return the next point, how far it is, and the zeros between; None: there is none.

    A step is halved if the curve bends too much in it, or if more happens there than its zeros tell.
    """
    while length >= _LEAST:
        ahead = advanced(curve, here, length)
        if (
            ahead is not None
            and here.tangent @ (curve.weights * ahead.tangent) >= _STRAIGHT
            and not _is_fold_back(curve, here, ahead)
        ):
            zeros = sorted(_zeros(curve, here, ahead, length), key=lambda zero: zero[0])
            if length <= _FINE or curve.explains(here, ahead, [(name, place) for _, name, place in zeros]):
                return ahead, length, zeros
        length /= 2.0
    return None


def _is_fold_back(curve: Curve, here: Point, ahead: Point) -> bool:
    """Whether a step goes the other way than its beginning's tangent: it has jumped to another curve."""
    return float(here.tangent @ (curve.weights * (ahead.u - here.u))) <= 0.0


def _is_back(curve: Curve, first: Point, here: Point, ahead: Point, length: float) -> bool:
    """Whether a step passes the first point, in the first direction."""
    if len(first.u) != len(ahead.u) or len(first.u) != len(here.u):
        return False
    chord = ahead.u - here.u
    to_first = first.u - here.u
    square = float(chord @ (curve.weights * chord))
    along = float(to_first @ (curve.weights * chord)) / max(square, 1e-300)
    beside = to_first - along * chord
    off = float(np.sqrt(beside @ (curve.weights * beside)))
    is_along = bool(first.tangent @ (curve.weights * ahead.tangent) > 0.9)
    return is_along and 0.0 < along <= 1.0 and off < 0.1 * length


def _zeros(curve: Curve, here: Point, ahead: Point, length: float) -> Iterator[tuple[float, str, Point]]:
    for name, after in ahead.tests.items():
        before = here.tests.get(name)
        if before is None or not np.isfinite(before) or not np.isfinite(after):
            continue
        if name in curve.ends and abs(before) < _TINY:
            before = _TINY
        if before * after < 0.0 or (after == 0.0 and before != 0.0):
            if max(abs(before), abs(after)) < curve.noise.get(name, 0.0):
                continue
            travelled, place = _located(curve, here, ahead, length, name, before)
            # at a branch point itself the tangent is not determined
            place.tangent = unit(curve, here.tangent + ahead.tangent)
            yield travelled, name, place


def _located(
    curve: Curve, here: Point, ahead: Point, length: float, name: str, before: float
) -> tuple[float, Point]:
    """Return where a test is 0 in a step, by regula falsi that halves the side which stays (Illinois)."""
    low, high, f_low, f_high = 0.0, length, before, ahead.tests[name]
    best, place = length, ahead
    left, right = here, ahead
    side = 0
    for number in range(_HALVINGS):
        middle = 0.5 * (low + high)
        if number % 4 != 3 and f_high != f_low:
            secant = high - f_high * (high - low) / (f_high - f_low)
            middle = secant if low < secant < high else middle
        tried = _advanced_in(curve, here, low, high, middle)
        if tried is None:  # next to a branch point: a straight line between its sides, made exact by others
            break
        middle, value = tried[0], tried[1].tests[name]
        best, place = tried
        if value == 0.0 or high - low < _LOCATED * (1.0 + length):
            break
        if (value < 0.0) == (f_high < 0.0):
            high, f_high, right = middle, value, place
            f_low = f_low / 2.0 if side == 1 else f_low
            side = 1
        else:
            low, f_low, left = middle, value, place
            f_high = f_high / 2.0 if side == -1 else f_high
            side = -1
    else:
        return best, place
    if tried is None:
        best = (low * f_high - high * f_low) / (f_high - f_low) if f_high != f_low else 0.5 * (low + high)
        part = (best - low) / (high - low)
        place = Point((1.0 - part) * left.u + part * right.u, here.tangent, right.tests, right.facts)
    return best, place


def _advanced_in(
    curve: Curve, here: Point, low: float, high: float, middle: float
) -> tuple[float, Point] | None:
    """Return a point in a bracket, at the middle if that can be."""
    for length in (middle, *(low + part * (high - low) for part in _PARTS)):
        found = advanced(curve, here, length)
        if found is not None:
            return length, found
    return None
