"""Programs by grammar on both back ends: the same samples, final values and console text, or the same error."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tests.fuzz.grammar import ProgramMaker
from tests.programs.checking import UNREPEATABLE, difference
from tests.programs.execution import execute

if TYPE_CHECKING:
    from random import Random

    from tests.programs.execution import Outcome

TOLERANCE = 1e-6
STEPS_MOST = 3000
"""A model that a solver finds hard takes native code a second and NumPy an hour: it is left to native code."""


def generate(rng: Random) -> str:
    """Return a program."""
    return ProgramMaker(rng).program()


def check(text: str) -> None:
    """Run it on both and compare."""
    native = execute(text, "native", Path.cwd())
    if sum(run.steps for run in native.runs) > STEPS_MOST:
        return
    reference = execute(text, "reference", Path.cwd())
    assert _codes(native) == _codes(reference), f"errors {_codes(native)}, reference {_codes(reference)}"
    assert len(native.runs) == len(reference.runs), "not as many runs"
    for number, (a, b) in enumerate(zip(native.runs, reference.runs, strict=True), 1):
        assert (a.count, a.ended) == (b.count, b.ended), (
            f"run {number}: {a.count} samples {a.ended}, reference {b.count} {b.ended}"
        )
        for k, name in enumerate(["t", *(column.name for column in a.columns)] if a.count else []):
            with np.errstate(all="ignore"):
                worst = difference(a.rows[: a.count, k], b.rows[: b.count, k])
            assert worst <= TOLERANCE, f"run {number}: {name} differs by {worst:.3g}"
    assert native.quantities.keys() == reference.quantities.keys(), "names defined by one only"
    for name, value in native.quantities.items():
        with np.errstate(all="ignore"):
            worst = difference(value, reference.quantities[name])
        assert worst <= TOLERANCE or name in UNREPEATABLE, f"{name} differs by {worst:.3g}"


def _codes(outcome: Outcome) -> list[int]:
    return [problem.code for problem in outcome.error.diagnostics] if outcome.error else []
