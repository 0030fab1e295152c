"""How far two runs of a segment lie apart: the table that `compare` prints."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.integration.rules import RULES

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from desire_tui.engine.runtime.run_record import RunRecord

_SAME_TIME = 1e-6
"""Of COMINT: samples so near stand at one time."""
_SAMPLES_MOST = 200_000


def needs_steps_of(one: RunRecord, other: RunRecord) -> tuple[RunRecord, float] | None:
    """Return the run to be made again and the distance of its samples, so that both have the same times.

    None: most samples stand at the same times as it is, or there is no such distance.
    """
    if 2 * len(common(one, other)[0]) >= min(one.count, other.count):
        return None
    fixed = [run for run in (one, other) if RULES[run.rule].kind == "fixed"]
    if not fixed:
        return None
    coarse = max(fixed, key=lambda run: run.dt)
    again = other if coarse is one else one
    ratio = coarse.dt / again.dt
    if RULES[again.rule].kind == "fixed" and abs(ratio - round(ratio)) > 1e-9 * ratio:
        return None
    return (again, coarse.dt) if abs(coarse.t_max) / coarse.dt < _SAMPLES_MOST else None


def common(one: RunRecord, other: RunRecord) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return the rows of both runs that stand at the same times."""
    a, b = (run.t if run.t_max > 0.0 else -run.t for run in (one, other))
    near = np.minimum(np.clip(np.searchsorted(b, a), 1, max(len(b) - 1, 1)), len(b) - 1)
    below = np.maximum(near - 1, 0)
    nearest = np.where(np.abs(b[below] - a) <= np.abs(b[near] - a), below, near)
    comint = min(abs(run.t_max) / (run.nn - 1) for run in (one, other))
    same = np.abs(b[nearest] - a) <= _SAME_TIME * comint
    return np.flatnonzero(same), nearest[same]


def table(
    one: RunRecord,
    other: RunRecord,
    named: Callable[[RunRecord], str],
    sampled: tuple[RunRecord, RunRecord],
) -> str:
    """Return for each variable the largest difference, its time, and both final values.

    `sampled` are the same runs, perhaps with samples at other times: the differences are theirs.
    """
    first, second = named(one), named(other)
    rows = common(*sampled)
    lines = [f"{first}: {one.steps} steps, {second}: {other.steps} steps"]
    cells = [["", "largest", "at t", first, second]]
    for name in dict.fromkeys(column.name for column in one.columns):
        a, b = (run.values(name)[at] for run, at in zip(sampled, rows, strict=True))
        difference = np.abs(a - b)
        at = int(np.nanargmax(difference)) if not np.isnan(difference).all() else 0
        ends = [f"{run.values(name)[-1]:.8g}" for run in (one, other)]
        cells.append([name, f"{difference[at]:.6g}", f"{sampled[0].t[rows[0]][at]:.6g}", *ends])
    lines += _aligned(cells)
    return "\n".join([*lines, *_remarks(one, other, sampled, len(rows[0]))]) + "\n"


def _aligned(cells: list[list[str]]) -> list[str]:
    """Return rows in columns no wider than they need, so that they fit beside a graph."""
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    return ["  ".join([row[0].ljust(widths[0]), *map(str.rjust, row[1:], widths[1:])]) for row in cells]


def _remarks(
    one: RunRecord, other: RunRecord, sampled: tuple[RunRecord, RunRecord], compared: int
) -> list[str]:
    lines = []
    ends = one.t[-1], other.t[-1]
    if abs(ends[0] - ends[1]) > _SAME_TIME * abs(one.t_max) / (one.nn - 1):
        lines.append(f"the last samples stand at t = {ends[0]:.6g} and t = {ends[1]:.6g}")
    count = min(run.count for run in sampled)
    if compared < count:
        lines.append(
            f"{count - compared} of {count} samples stand at different times and are not compared: "
            "let TMAX/(NN - 1) be a multiple of DT"
        )
    if other.message:
        lines.append(other.message)
    return lines
