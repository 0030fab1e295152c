"""The plan of a run: what it needs to know before its first step (language.md 8.2, 11)."""

from __future__ import annotations

from math import ceil

from desire_tui.engine.data_classes import dataclass, replace
from desire_tui.engine.integration.rules import RULES

ROUNDING = 1e-9
"""Relative tolerance wherever steps are counted: 0.1 + 0.2 must not be one step longer than 0.3."""


@dataclass(frozen=True, slots=True)
class RunPlan:
    """Everything a run needs to know before its first step; times in the program's unit.

    The run goes from `t0` to `t0` + `t_max` (`backward`: to `t0` - `t_max`, TMAX being -`t_max`), with `nn`
    communication points `comint` apart, of which every `every`-th gives a sample (MM). `dt`, `dt_max`,
    `dt_min` are the first, largest and smallest step; `error_max` and `error_min` (ERMAX, ERMIN) bound the
    test difference, of state number `checked` only (CHECKN; 0: of all). `scale` is the display's.
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
    backward: bool = False
    error_absolute: float = 0.0

    @property
    def span(self) -> float:
        """TMAX, with its sign."""
        return -self.t_max if self.backward else self.t_max

    @property
    def error_one(self) -> float:
        """What rules 4, 7 and 8 add to |x|: error ≤ ERMAX·(|x| + 1), or ERMAX·|x| + ERABS if that is set."""
        return self.error_absolute / self.error_max if self.error_absolute and self.error_max else 1.0

    @property
    def is_free(self) -> bool:
        """Whether steps of rules 4, 7 and 8 may go beyond communication points: DTMAX is above COMINT.

        Points at the run's ends alone stop no step.
        """
        wider = self.nn > 2 and self.dt_max > self.comint * (1.0 + ROUNDING)
        return wider and RULES[self.rule].kind == "variable"

    @property
    def tolerance(self) -> float:
        """ERMAX if the rule looks at it, else 0."""
        return self.error_max if RULES[self.rule].controls_error else 0.0

    def sampled_every(self, spacing: float) -> RunPlan:
        """Return the plan with samples so far apart; steps that ended on all points still do."""
        steps = ceil(self.t_max / spacing * (1 - ROUNDING))
        ends_there = RULES[self.rule].kind == "variable" and not self.is_free
        return replace(
            self, nn=steps + 1, t_max=steps * spacing, comint=spacing, dt=min(self.dt, spacing),
            dt_max=min(self.dt_max, spacing) if ends_there else self.dt_max, every=1,
        )  # fmt: skip

    @property
    def rows_most(self) -> int:
        """Samples the run takes at most: every MM-th communication point, and the last one."""
        return (self.nn - 1) // self.every + 2
