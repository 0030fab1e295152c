"""The settings of a run and their defaults at drun (language.md 8.1; book 1.2.4, 4.1, 8.2.1, A.2)."""

from __future__ import annotations

from math import inf, isfinite, isnan, ulp
from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import dataclass, replace
from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.integration.rules import DUMMY, RULES, rule_numbered
from desire_tui.engine.runtime.plan import ROUNDING, RunPlan
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
    Kind,
    T,
)  # fmt: skip
from desire_tui.engine.whole_numbers import whole

if TYPE_CHECKING:
    from desire_tui.engine.integration.rules import Rule
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.source import Source, Span
    from desire_tui.engine.values import Values

POINTS_DEFAULT = 251
ERMAX_DEFAULT = 0.001
_ROUNDING_NN = 1e-6
_RESOLVED = 2.0
"""Distances of neighbouring numbers near t that a step takes at least."""
_COUNTED_MOST = 10**12
"""NN and MM: no run lives to see more, and products of the two stay within 64 bits."""


@dataclass(frozen=True, slots=True)
class StepHistory:
    """The DT that the program last set, the one a run began with, the one it left if that is another."""

    requested: float | None = None
    at_start: float | None = None
    at_end: float | None = None

    def least(self, dt: float) -> float:
        """Return what DTMIN follows: `dt`, or the program's own DT if a run has made that larger."""
        return dt if self.requested is None else min(dt, self.requested)


SavedDefaults = tuple[dict[int, float], StepHistory, frozenset[str]]
"""Defaults by their slots, what became of DT, and the settings that were warned of."""


class Defaults:
    """Makes plans, and remembers which system variables hold a default rather than the program's own number.

    Defaults are written into the values, so that scripts can read them after the run, but count as *not set*
    at the next drun as long as nobody changed them: with TMAX changed, DT follows again. A DT that a run made
    of the program's own is no setting either: the next run goes on with it, but does not complain about it.
    """

    def __init__(self, values: Values) -> None:
        self._values = values
        self._supplied: dict[int, float] = {}
        self._steps = StepHistory()
        self._generation = values.generation
        self._warnings: list[Diagnostic] = []
        self._warned: set[str] = set()

    def plan(self, segment: Segment, rule: int, source: Source, at: Span | None) -> RunPlan:
        """Return the plan of a run of `segment` under `irule`. Errors 86, 87, 93, 110, 124."""
        if segment.row_chosen is not None and not self._values.cells[IROW] > 0.0:
            facts = {"value": self._values.cells[IROW]}
            raise DesireError(Diagnostic("row-not-chosen", segment.row_chosen.span, facts, segment.source))
        if self._values.generation != self._generation:
            self._supplied.clear()
            self._steps = StepHistory()
            self._warned.clear()
            self._generation = self._values.generation
        self._warnings.clear()
        try:
            plan = self._plan(segment, rule_numbered(rule) if segment.order else RULES[DUMMY])
        except DesireError as error:
            placed = [Diagnostic(d.key, at, d.facts, source) for d in error.diagnostics]
            raise DesireError(*placed) from None
        self._warnings = [replace(d, span=at, source=source) for d in self._warnings]
        return plan

    def warnings(self) -> tuple[Diagnostic, ...]:
        """Return what the last plan took in place of settings that cannot be; each once in a program."""
        return tuple(self._warnings)

    def _plan(self, segment: Segment, rule: Rule) -> RunPlan:
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
        if not isfinite(t_max) or t_max == 0.0:
            raise _error("tmax-zero", value=t_max)
        backward, t_max = t_max < 0.0, abs(t_max)
        comint = t_max / (nn - 1)
        dt = self._step(rule, comint)
        if not dt >= _RESOLVED * ulp(t0):
            raise _error("time-unresolved", t=t0, dt=dt, gap=ulp(t0))
        step_rule = rule.kind == "variable"
        least = self._steps.least(dt) if step_rule else 0.0
        longest = t_max if rule.has_interpolant else comint  # whose steps go beyond samples
        error_max = self._tolerance(rule)
        return RunPlan(
            rule=rule.number, t0=t0, t_max=t_max, nn=nn, comint=comint, dt=dt,
            dt_max=self._or_default("DTMAX", DTMAX, longest, counts=rule.controls_error),
            dt_min=self._or_default("DTMIN", DTMIN, least / 65536, counts=step_rule),
            error_max=error_max,
            error_min=self._or_default("ERMIN", ERMIN, error_max / 100, counts=step_rule),
            every=max(self._counted("MM", self._own(MM) or 1.0), 1),
            checked=self._checked(segment.order) if step_rule else 0,
            scale=cells[SCALE],
            backward=backward,
            error_absolute=self._absolute() if rule.controls_error else 0.0,
        )  # fmt: skip

    def saved(self) -> SavedDefaults:
        """Return what is a default now, for `restore`."""
        return self._supplied.copy(), self._steps, frozenset(self._warned)

    def restore(self, saved: SavedDefaults) -> None:
        """Take up what was a default when `saved` was called; the values have been put back too."""
        supplied, self._steps, warned = saved
        self._supplied, self._warned = supplied.copy(), set(warned)

    def follow(self) -> None:
        """Note, after a run or reset, that the DT which it left is not the program's own setting."""
        now = self._values.cells[DT]
        if DT in self._supplied:
            self._supplied[DT] = now
        elif now != self._steps.at_start or self._steps.at_end == self._steps.at_start:
            self._steps = replace(self._steps, at_end=now)

    def _points(self) -> int:
        nn = self._own(NN)
        if nn is not None:
            given = self._counted("NN", nn + _ROUNDING_NN)  # TMAX/DT + 1 may be a little less than whole
            if given > 1:
                return given
        points = POINTS_DEFAULT
        t_max, dt = self._own(TMAX), self._own(DT)
        if dt is not None and dt == self._steps.at_end:
            dt = self._steps.requested
        if nn is None and t_max is not None and dt is not None and dt > 0.0:
            points = max(int(min(float(points), abs(t_max) / dt * (1 + ROUNDING) + 1.0)), 2)
        self._supply(NN, float(points))
        return points

    def _step(self, rule: Rule, comint: float) -> float:
        if rule.kind == "dummy":
            return comint
        dt = self._own(DT)
        if dt is None:
            return self._supply(DT, comint / 2)
        if not isfinite(dt):
            raise _error("setting-not-finite", name="DT", value=dt)
        if dt <= 0.0:
            self._warn("setting-not-positive", "DT", value=dt, taken=comint / 2)
            return self._supply(DT, comint / 2)
        is_left = dt == self._steps.at_end
        if dt > comint * (1 + ROUNDING):
            if not is_left:
                raise _error("dt-above-comint", dt=dt, comint=comint)
            dt = comint
            self._values.assign(DT, dt)
        requested = self._steps.requested if is_left else dt
        self._steps = StepHistory(requested=requested, at_start=dt, at_end=dt if is_left else None)
        return dt

    def _tolerance(self, rule: Rule) -> float:
        own = self._own(ERMAX)
        if own == inf and rule.controls_error:
            raise _error("setting-not-finite", name="ERMAX", value=own)
        if own == 0.0 and rule.solver == "Taylor":
            return 0.0  # as exact as numbers are
        if own is None and rule.has_interpolant:
            self._warn("ermax-missing", "ERMAX", rule=rule.number, taken=ERMAX_DEFAULT)
        return self._or_default("ERMAX", ERMAX, ERMAX_DEFAULT, counts=rule.controls_error)

    def _absolute(self) -> float:
        """Return ERABS: no system variable, since programs may use the name; a number that they may set.

        Error 87: it is below 0, inf or nan.
        """
        found = self._values.find("ERABS")
        if found is None or found.shape or found.is_state or found.kind is not Kind.REAL:
            return 0.0
        value = self._values.cells[found.slot]
        if not self._values.is_defined(found):
            return 0.0
        if not 0.0 <= value < inf:
            raise _error("tolerance-negative", name="ERABS", value=value)
        return value

    def _checked(self, order: int) -> int:
        value = self._own(CHECKN) or 0.0
        checked = whole(value, 0, order)
        if checked is None:
            raise _error("checkn-out-of-range", value=value, order=order)
        return checked

    def _counted(self, name: str, value: float) -> int:
        """Return a setting that counts something, truncated; error 87 for what cannot be counted to."""
        count = whole(value, -_COUNTED_MOST, _COUNTED_MOST)
        if count is None:
            raise _error("setting-uncountable", name=name, value=value, most=float(_COUNTED_MOST))
        return count

    def _or_default(self, name: str, slot: int, default: float, *, counts: bool) -> float:
        """Return a setting of the step's control; where the rule `counts` on it, only if it is above 0."""
        own = self._own(slot)
        if not counts:
            return default if own is None else own
        if own is not None:
            if isnan(own):
                raise _error("setting-not-finite", name=name, value=own)
            if own > 0.0:
                return own
            self._warn("setting-not-positive", name, value=own, taken=default)
        return self._supply(slot, default)

    def _warn(self, key: str, name: str, **facts: object) -> None:
        if name not in self._warned:
            self._warned.add(name)
            self._warnings.append(Diagnostic(key, facts={"name": name, **facts}, severity="warning"))

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
