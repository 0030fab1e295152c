"""Values given from outside, as `--set` does and as Python's `set=` does."""

from __future__ import annotations

from typing import TYPE_CHECKING

import desire_tui
from desire_tui.batch.set_option import from_texts
from tests.fuzz.corpus import programs
from tests.fuzz.mutations import mutated

if TYPE_CHECKING:
    from random import Random

STATUS = frozenset({"done", "failed", "stopped", "limit"})
NAMES = """x y z a b t n m x[1] A[1,2] A[9,9] v[0] v[-1] v[2] W[1] DT TMAX NN t0 CHECKN scale irule MM DTMAX DTMIN ERMAX PI sin
NOSUCH x[ ] _ 1 x.y started drun p$ é""".split()  # noqa: SIM905
VALUES = """0 1 -1 3 0.5 1e308 -1e308 1e-320 inf -inf nan 2^64 1e19 9007199254740993 1,2,3 1,2;3,4 1,2;3 , ; '' 1e 0x10 1_0 ١
-0""".split()  # noqa: SIM905


def generate(rng: Random) -> list[str]:
    """Return a program and settings."""
    text = rng.choice(programs())
    names = (
        *NAMES,
        *(
            line.partition("=")[0].strip()
            for row in text.splitlines()
            for line in row.split("|")
            if "=" in line
        ),
    )
    made = [f"{rng.choice(names)}={rng.choice(VALUES)}" for _ in range(rng.randint(1, 3))]
    return [text, *(mutated(s, rng, 1) if rng.random() < 0.15 else s for s in made)]


def check(parts: list[str]) -> None:
    """Refuse them with ValueError, or run the program with them."""
    if not parts:
        return
    text, *settings = parts
    try:
        values = from_texts(settings)
    except ValueError:
        return
    try:
        result = desire_tui.run(text + "\n", set=values, timeout=0.5)
    except ValueError as refused:
        assert "cannot be" in str(refused)  # noqa: PT017
        return
    assert result.status in STATUS
    assert result.status != "failed" or result.problems
