"""The settings of a run and their defaults at drun (language.md 8.1; book 1.2.4, 4.1, 8.2.1, A.2)."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.values import (
    CHECKN,
    DT,
    DTMAX,
    DTMIN,
    ERMAX,
    ERMIN,
    IROW,
    MM,
    NN,
    SCALE,
    TMAX,
    T,
)  # fmt: skip

if TYPE_CHECKING:
    from collections.abc import Mapping

    from desire_tui.engine.lowered import Segment
    from desire_tui.engine.source import Source, Span
    from desire_tui.engine.values import Values

POINTS_DEFAULT = 251
ROUNDING = 1e-9
"""Relative tolerance wherever steps are counted: 0.1 + 0.2 must not be one step longer than 0.3."""

_ROUNDING_NN = 1e-6

DUMMY = 0
VARIABLE_STEP = frozenset({4, 7, 8})
VARIABLE_ORDER = frozenset(range(9, 17))


@dataclass(frozen=True, slots=True)
class Plan:
    """Everything a run needs to know before its first step; times in the program's unit.

    The run goes from `t0` to `t0` + `t_max` (TMAX), with `nn` communication points `comint` apart, of which
    every `every`-th gives a sample (MM). `dt`, `dt_max`, `dt_min` are the first, largest and smallest step;
    `error_max` and `error_min` (ERMAX, ERMIN) bound the test difference, of state number `checked` only
    (CHECKN; 0: of all). `scale` is the display's.
    """

    rule: int
    t0: float
    t_max: float
    nn: int
    comint: float
    dt: float
    dt_max: float
    dt_min: float
    error_max: float
    error_min: float
    every: int
    checked: int
    scale: float

    @property
    def tolerance(self) -> float:
        """ERMAX if the rule looks at it, else 0."""
        return self.error_max if self.rule in VARIABLE_STEP | VARIABLE_ORDER else 0.0

    @property
    def rows_most(self) -> int:
        """Samples the run takes at most: every MM-th communication point, and the last one."""
        return (self.nn - 1) // self.every + 2


class Defaults:
    """Makes plans, and remembers which system variables hold a default rather than the program's own number.

    Defaults are written into the values, so that scripts can read them after the run, but count as *not set*
    at the next drun as long as nobody changed them: with TMAX changed, DT follows again.
    """

    def __init__(self, values: Values) -> None:
        self._values = values
        self._supplied: dict[int, float] = {}
        self._generation = values.generation

    def plan(self, segment: Segment, rule: int, source: Source, at: Span | None) -> Plan:
        """Return the plan of a run of `segment` under `irule` (1 if never set). Errors 87, 93, 110, 124."""
        if segment.row_chosen is not None and not self._values.cells[IROW] >= 1.0:
            facts = {"value": self._values.cells[IROW]}
            raise DesireError(Diagnostic("row-not-chosen", segment.row_chosen.span, facts, segment.source))
        if self._values.generation != self._generation:
            self._supplied.clear()
            self._generation = self._values.generation
        try:
            return self._plan(segment, rule if segment.order else DUMMY)
        except DesireError as error:
            placed = [Diagnostic(d.key, at, d.facts, source) for d in error.diagnostics]
            raise DesireError(*placed) from None

    def _plan(self, segment: Segment, rule: int) -> Plan:
        cells = self._values.cells
        t0 = self._own(T)
        if t0 is None:
            t0 = 0.0 if segment.order else 1.0
            self._values.assign(T, t0)
        nn = self._points()
        t_max = self._own(TMAX)
        if t_max is None:
            if segment.order:
                raise _error("tmax-missing")
            t_max = self._supply(TMAX, float(nn - 1))
        if not (isfinite(t_max) and t_max > 0.0):
            raise _error("tmax-not-positive", value=t_max)
        comint = t_max / (nn - 1)
        dt = self._step(rule, comint)
        step_rule = rule in VARIABLE_STEP
        error_max = self._tolerance(rule)
        every = self._own(MM)
        return Plan(
            rule=rule, t0=t0, t_max=t_max, nn=nn, comint=comint, dt=dt,
            dt_max=self._largest_step(rule, comint),
            dt_min=self._or_default(DTMIN, dt / 16 if step_rule else 0.0, supply=step_rule),
            error_max=error_max,
            error_min=self._or_default(ERMIN, error_max / 100, supply=step_rule),
            every=max(int(every), 1) if every is not None and isfinite(every) else 1,
            checked=self._checked(segment.order) if step_rule else 0,
            scale=cells[SCALE],
        )  # fmt: skip

    def saved(self) -> dict[int, float]:
        """Return what is a default now, for `restore`."""
        return self._supplied.copy()

    def restore(self, supplied: Mapping[int, float]) -> None:
        """Take up what was a default when `saved` was called; the values have been put back too."""
        self._supplied = dict(supplied)

    def follow(self) -> None:
        """Note, after a run or reset, that a DT which a rule made of a default is still nobody's wish."""
        if DT in self._supplied:
            self._supplied[DT] = self._values.cells[DT]

    def _points(self) -> int:
        nn = self._own(NN)
        if nn is not None and not isfinite(nn):
            raise _error("nn-not-a-number", value=nn)
        if nn is not None and int(nn + _ROUNDING_NN) > 1:
            return int(nn + _ROUNDING_NN)  # TMAX/DT + 1 may be a little less than whole
        points = POINTS_DEFAULT
        t_max, dt = self._own(TMAX), self._own(DT)
        if nn is None and t_max is not None and dt is not None and dt > 0.0:
            points = max(int(min(float(points), t_max / dt * (1 + ROUNDING) + 1.0)), 2)
        self._supply(NN, float(points))
        return points

    def _step(self, rule: int, comint: float) -> float:
        if rule == DUMMY:
            return comint
        dt = self._own(DT)
        if dt is None:
            return self._supply(DT, comint / 2)
        if not (isfinite(dt) and dt > 0.0):
            raise _error("dt-not-positive", value=dt)
        if dt > comint * (1 + ROUNDING):
            raise _error("dt-above-comint", dt=dt, comint=comint)
        return dt

    def _largest_step(self, rule: int, comint: float) -> float:
        own = self._own(DTMAX)
        if own is not None and rule in VARIABLE_STEP | VARIABLE_ORDER and not own >= 0.0:
            raise _error("dtmax-not-positive", value=own)
        return self._or_default(DTMAX, comint, supply=rule in VARIABLE_STEP)

    def _tolerance(self, rule: int) -> float:
        own = self._own(ERMAX)
        if own is None and rule in VARIABLE_ORDER:
            raise _error("ermax-missing", rule=rule)
        if own is not None and rule in VARIABLE_STEP | VARIABLE_ORDER and not (isfinite(own) and own > 0.0):
            raise _error("ermax-not-positive", value=own)
        return self._or_default(ERMAX, 0.001, supply=rule in VARIABLE_STEP)

    def _checked(self, order: int) -> int:
        checked = self._own(CHECKN) or 0.0
        if not (isfinite(checked) and 0 <= int(checked) <= order):
            raise _error("checkn-out-of-range", value=checked, order=order)
        return int(checked)

    def _or_default(self, slot: int, default: float, *, supply: bool) -> float:
        own = self._own(slot)
        if own is not None:
            return own
        return self._supply(slot, default) if supply else default

    def _own(self, slot: int) -> float | None:
        """Return what the program itself set, None where it set nothing."""
        value = self._values.cells[slot]
        if not self._values.defined[slot] or self._supplied.get(slot) == value:
            return None
        self._supplied.pop(slot, None)
        return value

    def _supply(self, slot: int, value: float) -> float:
        self._supplied[slot] = value
        self._values.assign(slot, value)
        return value


def _error(key: str, **facts: object) -> DesireError:
    return DesireError(Diagnostic(key, facts=facts))
