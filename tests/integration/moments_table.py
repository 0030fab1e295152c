"""Writes the table "at a moment" of docs/rules.md anew: `python -m tests.integration.moments_table`."""

from __future__ import annotations

from pathlib import Path

from desire_tui.engine.diagnostics import DesireError
from tests.integration.moments_problems import ERMAX, MOMENTS, RULES, Moment, error

PAGE = Path(__file__).parents[2] / "docs" / "rules.md"
BEGIN, END = "<!-- table: written by tests/integration/moments_table.py -->", "<!-- end of moments' table -->"
LIMIT = 10.0
"""In units of ERMAX."""


def cell(moment: Moment, rule: int) -> str:
    """The error in units of ERMAX, steps in brackets; beyond the limit in bold."""
    try:
        found, steps = error(moment, rule)
    except DesireError as failure:
        return f"error {failure.diagnostics[0].code}"
    text = f"{found:.1g}" if found > 1e-3 else "0"
    return f"{text if found <= LIMIT else f'**{text}**'} ({steps})"


def table() -> str:
    """Return the table: a row for each program, a column for each rule."""
    lines = ["| program | " + " | ".join(map(str, RULES)) + " |", "| --- " * (len(RULES) + 1) + "|"]
    lines += [
        f"| {moment.title} | " + " | ".join(cell(moment, rule) for rule in RULES) + " |" for moment in MOMENTS
    ]
    return "\n".join([*lines, "", f"ERMAX = {ERMAX:g}; DT, the first step, is 0.01.", ""])


def main() -> None:
    """Replace what stands between the marks."""
    text = PAGE.read_text(encoding="utf-8")
    before, _, rest = text.partition(BEGIN)
    after = rest.partition(END)[2]
    PAGE.write_text(f"{before}{BEGIN}\n{table()}\n{END}{after}", encoding="utf-8")


if __name__ == "__main__":
    main()
