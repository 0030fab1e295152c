"""Writes the table of docs/rules.md anew: `python -m tests.integration.rules_table`; numbers of rules behind it: their rows alone."""

from __future__ import annotations

import sys
from pathlib import Path

from tests.integration.eight_problems import ERMAX, EXPLICIT, LIMITS, RULES, Outcome, limit, problems, solve

PAGE = Path(__file__).parents[2] / "docs" / "rules.md"
BEGIN, END = "<!-- table: written by tests/integration/rules_table.py -->", "<!-- end of table -->"


def cell(rule: int, outcome: Outcome) -> str:
    """An error as times ERMAX, or as it is for the fixed rules; beyond the limit in bold; steps in brackets."""
    if outcome.code is not None:
        return f"error {outcome.code}"
    assert outcome.error is not None
    text = f"{outcome.error:.0e}" if rule in EXPLICIT else f"{outcome.error / ERMAX:.2g}"
    if outcome.error > limit(rule):
        text = f"**{text}**"
    return f"{text} ({outcome.steps})"


def row(rule: int) -> str:
    """Return a rule's row."""
    return (
        f"| {rule} | " + " | ".join(cell(rule, solve(problem, rule, ERMAX)) for problem in problems()) + " |"
    )


def table() -> str:
    """Return the table: a row for each rule, a column for each problem."""
    made = problems()
    lines = ["| irule | " + " | ".join(p.name for p in made) + " |", "| --- " * (len(made) + 1) + "|"]
    lines += [row(rule) for rule in RULES]
    settings = (f"{p.name}: to t = {p.t_end:.4g}, DT {p.dt:g} / first step {p.first:g}" for p in made)
    limits = ", ".join(f"{value:g} for order {order}" for order, value in LIMITS.items())
    lines += ["", f"ERMAX = {ERMAX:g}; fixed rules must stay below {limits}. {'; '.join(settings)}.", ""]
    return "\n".join(lines)


def rows_anew(text: str, rules: set[int]) -> str:
    """Return the table with the rows of some rules made anew."""
    heads = {f"| {rule} |": rule for rule in rules}
    lines = text.split("\n")
    for at, line in enumerate(lines):
        rule = next((rule for head, rule in heads.items() if line.startswith(head)), None)
        if rule is not None:
            lines[at] = row(rule)
    return "\n".join(lines)


def main() -> None:
    """Replace what stands between the marks."""
    text = PAGE.read_text(encoding="utf-8")
    before, _, rest = text.partition(BEGIN)
    inside, _, after = rest.partition(END)
    made = rows_anew(inside, {int(word) for word in sys.argv[1:]}) if sys.argv[1:] else f"\n{table()}\n"
    PAGE.write_text(f"{before}{BEGIN}{made}{END}{after}", encoding="utf-8")


if __name__ == "__main__":
    main()
