"""The explicit Runge–Kutta rules as rows of coefficients (language.md section 11, the book's Table A.1).

One step from (t, x) with step DT:

    kᵢ = f(t + cᵢ·DT, x + DT·Σⱼ aᵢⱼ·kⱼ)        x(t + DT) = x + DT·Σᵢ bᵢ·kᵢ

and, for a rule with a variable step, the test difference of each state is `DT·|Σᵢ testᵢ·kᵢ|`. The rows are
exact fractions; back ends write them out as DT/denominator times a sum of whole multiples in the order of the
k's (`whole_multiples`), so that all give the same bits.
"""

from __future__ import annotations

from fractions import Fraction
from functools import cache
from math import lcm

from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.integration.rules import RULES, Rule

Row = tuple[Fraction, ...]

STILL_MOST = 4096
"""So many variable steps too short to move t end a run; some precede a state that becomes infinite."""


CHANGE: Row = (Fraction(1), Fraction(-1))
"""What code behind `step` has changed the first derivative by: k1 against the one before, in k2's place."""
LATE_PARTS, LATE_HOLD = 40_000, 100
"""Such a change comes late by up to a step. DT times it is kept below ERMAX by a smaller DT, down to the
run's length divided by the first number: a relay that holds a solution on its jump would go on for ever.
DT grows again after so many steps without a change: the next is late by a small part of the time since."""


@dataclass(frozen=True, slots=True)
class Tableau:
    """One explicit rule.

    `a[i]` has i entries (strictly lower triangle); `c[0]` is 0: the pass at the step's start gives k1. `test`
    is None for a fixed step.
    """

    rule: Rule
    c: Row
    a: tuple[Row, ...]
    b: Row
    test: Row | None = None

    @property
    def stages(self) -> int:
        """Derivative evaluations in a step."""
        return len(self.b)

    @property
    def variable(self) -> bool:
        """Whether the rule controls its step."""
        return self.test is not None


@cache
def whole_multiples(row: Row) -> tuple[int, tuple[int, ...]]:
    """Return a row as its common denominator and whole numerators: (1/6, 2/6, …) is 6, (1, 2, …)."""
    denominator = lcm(*(weight.denominator for weight in row))
    return denominator, tuple(int(weight * denominator) for weight in row)


def _row(denominator: int, *numerators: int) -> Row:
    return tuple(Fraction(n, denominator) for n in numerators)


EULER = Tableau(RULES[2], c=_row(1, 0), a=((),), b=_row(1, 1))
"""x + DT·k1."""

HEUN = Tableau(RULES[1], c=_row(1, 0, 1), a=((), _row(1, 1)), b=_row(2, 1, 1))
"""k2 at DT with k1; x + (k1 + k2)·DT/2."""

HEUN_FREE = Tableau(RULES[5], c=HEUN.c, a=HEUN.a, b=HEUN.b)
"""As rule 1."""

CLASSICAL = Tableau(
    RULES[3],
    c=_row(2, 0, 1, 1, 2),
    a=((), _row(2, 1), _row(2, 0, 1), _row(1, 0, 0, 1)),
    b=_row(6, 1, 2, 2, 1),
)
"""k2 and k3 at DT/2 with k1/2 and k2/2, k4 at DT with k3; x + (k1 + 2k2 + 2k3 + k4)·DT/6."""

RK42 = Tableau(
    RULES[4],
    c=CLASSICAL.c,
    a=CLASSICAL.a,
    b=CLASSICAL.b,
    test=_row(6, 1, -4, 2, 1),
)
"""As rule 3; compared with the midpoint rule x + DT·k2: (DT/6)·|k1 − 4k2 + 2k3 + k4|."""

RK21 = Tableau(
    RULES[7],
    c=HEUN.c,
    a=HEUN.a,
    b=HEUN.b,
    test=_row(2, 1, -1),
)
"""As rule 1; compared with Euler's x + DT·k1: (DT/2)·|k1 − k2|."""

NIESSE = Tableau(
    RULES[8],
    c=_row(2, 0, 1, 2),
    a=((), _row(2, 1), _row(1, -1, 2)),
    b=_row(6, 1, 4, 1),
    test=_row(3, 1, -2, 1),
)
"""k2 at DT/2 with k1/2, k3 at DT with −k1 + 2k2; x + (k1 + 4k2 + k3)·DT/6; test (DT/3)·|k1 − 2k2 + k3|.

The test is twice the difference from the midpoint rule.
"""

TABLEAUS: dict[int, Tableau] = {
    t.rule.number: t for t in (HEUN, EULER, CLASSICAL, RK42, HEUN_FREE, RK21, NIESSE)
}  # fmt: skip
"""The explicit rules by `irule` number."""
