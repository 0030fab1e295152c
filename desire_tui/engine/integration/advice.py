"""Warnings before a run: a JACOBIAN segment that is wrong, a diagonal for a matrix that is none."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.diagnostics import Diagnostic
from desire_tui.engine.integration.rules import rule_numbered, with_corrector

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from desire_tui.engine.lowered.segment import Segment

    Array = NDArray[np.float64]

STATES_MOST = 100
"""Larger models are not looked at: n² numbers would have to be found before each first run."""
_AGREES = 1e-3
_FAR = 10.0


@dataclass(frozen=True)
class Probe:
    """A model at the place where a run is about to start. Both functions leave everything as it was."""

    states: Array
    derivatives: Callable[[Array], Array]
    jacobian: Callable[[], Array] | None = None
    """The JACOBIAN segment's matrix, n by n."""


def advice(rule: int, segment: Segment, probe: Probe) -> tuple[Diagnostic, ...]:
    """Return warnings 462 (J disagrees with differences) and 463 (far from diagonal), at most one."""
    if len(probe.states) > STATES_MOST:
        return ()
    corrector = rule_numbered(rule).corrector
    if corrector == "diagonal":
        found = differences(probe)
        return _diagonal(rule, segment, found) if np.isfinite(found).all() else ()
    if corrector == "jacobian" and probe.jacobian is not None:
        given, found = probe.jacobian(), differences(probe)
        finite = np.isfinite(given).all() and np.isfinite(found).all()
        return _compare(segment, given, found) if finite else ()
    return ()


def differences(probe: Probe) -> Array:
    """Return the Jacobian by central differences."""
    x = probe.states
    found = np.empty((len(x), len(x)))
    for state in range(len(x)):
        h = 1e-6 * max(abs(x[state]), 1e-3)
        moved = x.copy()
        moved[state] = x[state] + h
        up = probe.derivatives(moved).copy()
        moved[state] = x[state] - h
        found[:, state] = (up - probe.derivatives(moved)) / (2.0 * h)
    return found


def _compare(segment: Segment, given: Array, found: Array) -> tuple[Diagnostic, ...]:
    size = np.maximum(np.abs(given), np.abs(found))
    excess = np.abs(given - found) - _AGREES * size - 1e-6 * size.max(initial=0.0)
    if not (excess > 0.0).any():
        return ()
    row, column = (
        int(i) for i in np.unravel_index(np.argmax(excess / np.where(size == 0.0, 1.0, size)), size.shape)
    )
    facts = {
        "row": row + 1, "column": column + 1, "given": given[row, column], "found": found[row, column],
        "state": _name(segment, row), "by": _name(segment, column),
    }  # fmt: skip
    where = segment.states[0].where
    for entry in segment.jacobian.entries if segment.jacobian else ():
        if (entry.row, entry.column) == (row, column) and entry.where is not None:
            where = entry.where
    return (Diagnostic("jacobian-wrong", where.span, facts, segment.source, "warning"),)


def _diagonal(rule: int, segment: Segment, found: Array) -> tuple[Diagnostic, ...]:
    own = np.abs(np.diag(found))
    others = np.abs(found).sum(axis=1) - own
    if not (others > _FAR * own).any():
        return ()
    where = segment.states[0].where
    facts = {"rule": rule, "better": with_corrector(rule_numbered(rule), "differences").number}
    return (Diagnostic("jacobian-not-diagonal", where.span, facts, segment.source, "warning"),)


def _name(segment: Segment, number: int) -> str:
    for states in segment.states:
        if states.first <= number < states.first + states.count:
            return f"{states.name}[{number - states.first + 1}]" if states.count > 1 else states.name
    return f"number {number + 1}"
