"""The explicit Runge–Kutta rules as rows of coefficients (language.md section 11, the book's Table A.1).

One step from (t, x) with step DT:

    kᵢ = f(t + cᵢ·DT, x + DT·Σⱼ aᵢⱼ·kⱼ)        x(t + DT) = x + DT·Σᵢ bᵢ·kᵢ

and, for a rule with a variable step, the test difference of each state is `DT·|Σᵢ testᵢ·kᵢ|`. The rows are
exact fractions; back ends write them out as products and sums in the order of the k's, so that all give the
same bits.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

Row = tuple[Fraction, ...]

STILL_MOST = 4096
"""So many variable steps too short to move t end a run; some precede a state that becomes infinite."""


@dataclass(frozen=True, slots=True)
class Tableau:
    """One explicit rule.

    `a[i]` has i entries (strictly lower triangle); `c[0]` is 0: the pass at the step's start gives k1. `test`
    is None for a fixed step. `dt_may_change`: the program may assign DT while a run goes on (rules 2, 3,
    5), so that t must be advanced from the current step instead of counted as t_start + k·DT.
    """

    rule: int
    name: str
    order: int
    c: Row
    a: tuple[Row, ...]
    b: Row
    test: Row | None = None
    dt_may_change: bool = False

    @property
    def stages(self) -> int:
        """Derivative evaluations in a step."""
        return len(self.b)

    @property
    def variable(self) -> bool:
        """Whether the rule controls its step."""
        return self.test is not None


def _row(denominator: int, *numerators: int) -> Row:
    return tuple(Fraction(n, denominator) for n in numerators)


EULER = Tableau(
    rule=2, name="Euler", order=1, c=_row(1, 0), a=((),), b=_row(1, 1), dt_may_change=True
)  # fmt: skip
"""x + DT·k1."""

HEUN = Tableau(
    rule=1, name="RK2 Heun", order=2, c=_row(1, 0, 1), a=((), _row(1, 1)), b=_row(2, 1, 1)
)  # fmt: skip
"""k2 at DT with k1; x + (k1 + k2)·DT/2."""

HEUN_FREE = Tableau(
    rule=5, name="RK2 Heun, DT may change", order=2, c=HEUN.c, a=HEUN.a, b=HEUN.b, dt_may_change=True
)  # fmt: skip
"""As rule 1."""

CLASSICAL = Tableau(
    rule=3,
    name="RK4",
    order=4,
    c=_row(2, 0, 1, 1, 2),
    a=((), _row(2, 1), _row(2, 0, 1), _row(1, 0, 0, 1)),
    b=_row(6, 1, 2, 2, 1),
    dt_may_change=True,
)
"""k2 and k3 at DT/2 with k1/2 and k2/2, k4 at DT with k3; x + (k1 + 2k2 + 2k3 + k4)·DT/6."""

RK42 = Tableau(
    rule=4,
    name="RK 4/2, variable step",
    order=4,
    c=CLASSICAL.c,
    a=CLASSICAL.a,
    b=CLASSICAL.b,
    test=_row(6, 1, -4, 2, 1),
    dt_may_change=True,
)
"""As rule 3; compared with the midpoint rule x + DT·k2: (DT/6)·|k1 − 4k2 + 2k3 + k4|."""

RK21 = Tableau(
    rule=7,
    name="RK 2/1, variable step",
    order=2,
    c=HEUN.c,
    a=HEUN.a,
    b=HEUN.b,
    test=_row(2, 1, -1),
    dt_may_change=True,
)
"""As rule 1; compared with Euler's x + DT·k1: (DT/2)·|k1 − k2|."""

NIESSE = Tableau(
    rule=8,
    name="RK–Niesse, variable step",
    order=3,
    c=_row(2, 0, 1, 2),
    a=((), _row(2, 1), _row(1, -1, 2)),
    b=_row(6, 1, 4, 1),
    test=_row(3, 1, -2, 1),
    dt_may_change=True,
)
"""k2 at DT/2 with k1/2, k3 at DT with −k1 + 2k2; x + (k1 + 4k2 + k3)·DT/6; test (DT/3)·|k1 − 2k2 + k3|.

The test is twice the difference from the midpoint rule.
"""

TABLEAUS: dict[int, Tableau] = {
    t.rule: t for t in (HEUN, EULER, CLASSICAL, RK42, HEUN_FREE, RK21, NIESSE)
}  # fmt: skip
"""The explicit rules by `irule` number: 1, 2, 3, 4, 5, 7, 8. Rule 0 only samples, 9 … 16 are CVODE's."""
