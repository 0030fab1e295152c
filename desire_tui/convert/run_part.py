"""The lines of a script that make the run: rule, times, tolerances, the `drun`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.convert.expression_text import number_text

if TYPE_CHECKING:
    from collections.abc import Iterator

    from desire_tui.convert.model import Settings

ADAPTIVE_FIXED_ERROR = frozenset({4, 7, 8})
STIFF_OR_ADAMS = range(9, 17)


def run_lines(settings: Settings) -> Iterator[str]:
    """Yield the lines from `irule` to `drun`."""
    first: list[str] = []
    if settings.rule:
        first.append(f"irule {settings.rule}")
    if settings.tolerance is not None:
        first.append(f"ERMAX = {number_text(settings.tolerance)}")
    if settings.seed is not None:
        first.append(f"SEED {settings.seed}")
    if settings.scale is not None:
        first.append(f"scale = {number_text(settings.scale)}")
    if settings.start or not settings.rule:
        first.append(f"t = {number_text(settings.start)}")
    if first:
        yield " | ".join(first)
    sampled = settings.duration
    if settings.transient > 0:
        yield from _transient(settings)
        sampled -= settings.transient
    yield _times(settings, sampled, settings.samples)
    yield "drun"


def _times(settings: Settings, duration: float, samples: int) -> str:
    times = [f"TMAX = {number_text(duration)}", f"NN = {samples}"]
    if settings.rule and settings.step is not None:
        times.insert(1, f"DT = {number_text(settings.step)}")
    return " | ".join(times)


def _transient(settings: Settings) -> Iterator[str]:
    """Yield a first run of which nothing is shown."""
    if settings.rule:
        times = _times(settings, settings.transient, 2)
        yield f"{times} | display 0 -- the transient"
        yield "drun"
        yield "display 1"
    else:  # the pass at its end is the first one of the run that is shown
        times = _times(settings, settings.transient - 1, round(settings.transient))
        yield f"{times} | display 0 -- the transient"
        yield "drun"
        yield f"display 1 | t = {number_text(settings.start + settings.transient)}"
