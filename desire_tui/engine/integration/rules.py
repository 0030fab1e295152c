"""The integration rules: one table for every place that must know what `irule n` means (language.md 11).

Coefficients of the explicit rules are in `tableaus`; everything else that depends on a rule's number is read
from here. Imports nothing heavy: front ends read it at their start.
"""

from __future__ import annotations

from typing import Literal

from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.diagnostics import DesireError, Diagnostic

Kind = Literal["dummy", "fixed", "variable", "multistep", "series"]
"""No integration; steps of DT; steps halved and doubled; step and order that follow the solution; step that
follows it, order that follows ERMAX."""
Solver = Literal["none", "tableau", "Adams", "BDF", "Taylor"]
"""Who makes a step: a run loop with a row of `tableaus`, CVODE with one of its two methods, or `taylor`."""
Corrector = Literal["fixed-point", "jacobian", "differences", "diagonal"]
"""How an implicit step's equations are solved: by functional iteration, or Newton's with a matrix from …"""


@dataclass(frozen=True, slots=True)
class Rule:
    """One rule.

    `order` is the highest a multistep rule goes to. `stages` counts the derivative evaluations of an explicit
    step, 0 where it varies. `dt_may_change`: the program may assign DT while a run goes on, so that t must be
    advanced from the current step instead of counted as t_start + k·DT.
    """

    number: int
    name: str
    kind: Kind
    solver: Solver
    order: int = 0
    stages: int = 0
    corrector: Corrector | None = None
    dt_may_change: bool = True
    use: str = ""
    """What it is good for, in a few words of Markdown."""

    @property
    def controls_error(self) -> bool:
        """Whether it looks at ERMAX."""
        return self.kind in ("variable", "multistep", "series")

    @property
    def has_interpolant(self) -> bool:
        """Whether its steps may go beyond communication points: it knows the solution inside them."""
        return self.kind in ("multistep", "series")

    @property
    def reads_jacobian(self) -> bool:
        """Whether it reads the program's JACOBIAN segment."""
        return self.corrector == "jacobian"

    @property
    def has_own_solver(self) -> bool:
        """Whether `bdf` can do it in CVODE's place where there are few states."""
        return self.solver == "BDF" and self.corrector in ("jacobian", "differences")

    @property
    def step(self) -> str:
        """What its step is, in words."""
        match self.kind:
            case "dummy":
                return "–"
            case "fixed":
                return "DT, may change" if self.dt_may_change else "DT, constant"
            case "variable":
                return "variable"
            case "multistep":
                return "variable, variable order"
            case "series":
                return "variable, order by ERMAX"


def _multistep(
    first: int, name: str, solver: Solver, order: int, uses: tuple[str, str, str, str]
) -> list[Rule]:
    correctors: tuple[tuple[Corrector, str], ...] = (
        ("fixed-point", "functional iteration"),
        ("jacobian", "JACOBIAN"),
        ("differences", "differences"),
        ("diagonal", "diagonal"),
    )
    return [
        Rule(first + k, f"{name}; {words}", "multistep", solver, order, corrector=corrector, use=uses[k])
        for k, (corrector, words) in enumerate(correctors)
    ]


_MANY_STATES = "very many states, each of which mostly acts on itself"

RULES: dict[int, Rule] = {
    rule.number: rule
    for rule in (
        Rule(0, "none", "dummy", "none", dt_may_change=False, use="difference equations only"),
        Rule(
            1, "RK2 (Heun)", "fixed", "tableau", 2, 2, dt_may_change=False,
            use="most models; the book's default",
        ),
        Rule(
            2, "Euler", "fixed", "tableau", 1, 1,
            use="switches, relays, sampled data where order does not help",
        ),
        Rule(
            3, "classical RK4", "fixed", "tableau", 4, 4,
            use="smooth models; long runs of oscillators and orbits",
        ),
        Rule(4, "RK 4/2", "variable", "tableau", 4, 4, use="smooth models with quiet and busy times"),
        Rule(5, "RK2 (Heun)", "fixed", "tableau", 2, 2, use="as 1"),
        Rule(7, "RK 2/1", "variable", "tableau", 2, 2, use="the same as 4 with little accuracy wanted"),
        Rule(8, "RK–Niesse", "variable", "tableau", 3, 3, use="between 4 and 7"),
        *_multistep(9, "Adams", "Adams", 12, (
            "smooth, not stiff, high accuracy", "as 9, where that needs small steps",
            "as 10, where equations cannot be differentiated", _MANY_STATES,
        )),
        *_multistep(13, "Gear", "BDF", 5, (
            "seldom", "**stiff systems**",
            "stiff systems whose equations cannot be differentiated", _MANY_STATES,
        )),
        Rule(
            17, "Taylor series", "series", "Taylor", 20,
            use="**high accuracy**: orbits, chaos, long runs of smooth models",
        ),
    )
}  # fmt: skip
"""Every rule by its `irule` number."""

DUMMY = 0
"""Of segments without `d/dt`, whatever `irule` says."""
DEFAULT_RULE = 1
"""`irule` if it was never set."""
MOST_USED_FIRST = (1, 3, 0, 2, 4, 5, 7, 8)
"""Rules with a run loop of their own, in the order in which programs are likely to want them."""


def rule_numbered(number: float) -> Rule:
    """Return a rule. DesireError 86: there is none of this number."""
    if number not in RULES:
        raise DesireError(Diagnostic("no-such-rule", facts={"rule": f"{number:g}"}))
    return RULES[int(number)]


def rules_of(*kinds: Kind) -> tuple[int, ...]:
    """Return the numbers of the rules of some kinds."""
    return tuple(rule.number for rule in RULES.values() if rule.kind in kinds)


def in_words(numbers: tuple[int, ...]) -> str:
    """Return numbers as a text names them: `4, 7, 8`, `9 … 16`; three or more in a row as a range."""
    runs: list[list[int]] = []
    for number in numbers:
        if runs and number == runs[-1][-1] + 1:
            runs[-1].append(number)
        else:
            runs.append([number])
    parts = [f"{run[0]} … {run[-1]}" if len(run) > 2 else ", ".join(map(str, run)) for run in runs]
    return ", ".join(parts)


def with_corrector(rule: Rule, corrector: Corrector) -> Rule:
    """Return the rule of the same method that solves its equations in another way."""
    return next(r for r in RULES.values() if (r.solver, r.corrector) == (rule.solver, corrector))


def markdown_table() -> str:
    """Return the table for help pages and documentation."""
    rows = [f"| {rule.number} | {rule.name} | {rule.step} | {rule.use} |" for rule in RULES.values()]
    return "\n".join(("| irule | name | step | use it for |", "| --- | --- | --- | --- |", *rows))
