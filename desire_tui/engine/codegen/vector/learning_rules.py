"""CLEARN, PLEARN and INTP in plain Python (`codegen.plain_python`); docs/neural.md says what they do.

W has `rows` rows of `cols` elements one behind the other.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from desire_tui.engine.integration.plain_types import Reals

_PUSHED_AWAY = 0.05
_PASSED_OVER = -1.0
"""In place of a row's squared distance: the row is out of this competition."""


def compete(
    out: Reals, w: Reals, x: Reals, h: Reals, has_h: int, rows: int, cols: int,
    rate: float, criterion: float, fast: int,
) -> float:  # fmt: skip
    """CLEARN. Return 0; 1 if no row is left, 2 if `h` is needed and there is none (the output is 0 then)."""
    if criterion >= 0.0 and not has_h:
        clear(out, rows)
        return 2.0
    distances(out, w, x, rows, cols)
    if criterion == 0.0:
        for i in range(rows):
            out[i] *= h[i]
    winner = nearest(out, rows, rows, 0)
    if criterion > 0.0:
        while winner >= 0 and h[winner] != 0.0 and not out[winner] <= criterion:
            out[winner] = _PASSED_OVER
            winner = nearest(out, rows, rows, 1)
        if winner < 0:
            clear(out, rows)
            return 1.0
        if out[winner] <= criterion:
            h[winner] = 1.0
    if criterion == 0.0 and rate < 0.0:
        second = nearest(out, rows, winner, 0)
        if second >= 0:
            approach(w, x, second * cols, cols, _PUSHED_AWAY * rate)
    if fast:
        for k in range(cols):
            w[winner * cols + k] = x[k]
    else:
        approach(w, x, winner * cols, cols, -rate if rate < 0.0 else rate)
    clear(out, rows)
    out[winner] = 1.0
    return 0.0


def match_templates(out: Reals, w: Reals, x: Reals, rows: int, cols: int, threshold: float) -> None:
    """INTP."""
    distances(out, w, x, rows, cols)
    for i in range(rows):
        out[i] = 1.0 if out[i] <= threshold else 0.0


def learn_components(out: Reals, w: Reals, x: Reals, rest: Reals, rows: int, cols: int, rate: float) -> None:
    """PLEARN; `out` is W·x, `rest` room for `cols` numbers: what the rows before make of x by now."""
    for k in range(cols):
        rest[k] = 0.0
    for i in range(rows):
        y = out[i]
        for k in range(cols):
            at = i * cols + k
            w[at] += rate * y * (x[k] - (rest[k] + w[at] * y))
            rest[k] += w[at] * y


def distances(out: Reals, w: Reals, x: Reals, rows: int, cols: int) -> None:
    """Set the squared distance of x from each row."""
    for i in range(rows):
        total = 0.0
        for k in range(cols):
            gap = w[i * cols + k] - x[k]
            total += gap * gap
        out[i] = total


def nearest(d: Reals, rows: int, but: int, marked: int) -> int:
    """Return the row of the least d, of several the last; -1: none. `marked`: some are passed over."""
    best = -1
    least = 0.0
    for step in range(rows):
        i = rows - 1 - step
        if i == but or (marked and d[i] == _PASSED_OVER):
            continue
        if best < 0 or d[i] < least:
            best = i
            least = d[i]
    return best


def approach(w: Reals, x: Reals, first: int, cols: int, rate: float) -> None:
    """Move a row towards x."""
    for k in range(cols):
        w[first + k] += rate * (x[k] - w[first + k])


def clear(out: Reals, rows: int) -> None:
    """Set all to 0."""
    for i in range(rows):
        out[i] = 0.0
