"""Programs by grammar on both back ends: the same samples, final values and console text, or the same error."""

from __future__ import annotations

import math
import re
from pathlib import Path
from threading import Timer
from typing import TYPE_CHECKING
from unittest.mock import patch
from zlib import crc32

from desire_tui.engine.codegen.jit.background import Improver
from desire_tui.engine.session.session import Session
from tests.fuzz.grammar import ProgramMaker
from tests.fuzz.roundings import other_roundings
from tests.programs.checking import UNREPEATABLE, difference
from tests.programs.execution import execute

if TYPE_CHECKING:
    from random import Random

    from desire_tui.engine.codegen.jit.background import Improvable
    from tests.programs.execution import Outcome

TOLERANCE = 1e-6
CALLS_MOST = 6000
"""A model that a solver finds hard takes native code a second and NumPy an hour: it is left to native code."""
SECONDS = 5.0
"""Then the user ends it. That it does end is checked: the fuzzer waits much longer."""
STOPPED = 301
FAST_EVERY = 8
"""Short runs are over before a second thread has compiled fast code, which costs as much as all the rest."""
OTHER_ROUNDINGS = 8
"""Runs to see whether a difference is rounding's."""
ENOUGH = 0.1
"""So much of it must they show, in the same variable."""
KIND = "kind"
NOT_FINITE, MOMENTS = 3, re.compile(r"^(event|every) |delay\(", re.MULTILINE)
"""A model with moments may make a step more before it is seen that a state is no number: the samples are the same."""


def generate(rng: Random) -> str:
    """Return a program."""
    return ProgramMaker(rng).program()


def check(text: str) -> None:
    """Run it on both and compare; a part of the programs, always the same ones, as fast code from the start."""
    fast = crc32(text.encode()) % FAST_EVERY == 0
    with patch.object(Improver, "add", _improve_at_once if fast else _improve_never):
        native = _ended_in_time(text)
    if STOPPED in _codes(native) or sum(run.derivative_calls for run in native.runs) > CALLS_MOST:
        return
    reference = execute(text, "reference", Path.cwd())
    wrong = {name: gap for name, gap in _differences(native, reference).items() if gap > TOLERANCE}
    if NOT_FINITE in _codes(native) and MOMENTS.search(text):
        wrong = {name: gap for name, gap in wrong.items() if name == KIND or name.startswith("run ")}
    for seed in range(OTHER_ROUNDINGS if wrong else 0):
        with other_roundings(seed):
            moved = _differences(execute(text, "reference", Path.cwd()), reference)
        if KIND in moved:
            return
        wrong = {name: gap for name, gap in wrong.items() if moved.get(name, 0.0) < ENOUGH * gap}
    assert KIND not in wrong, f"{_summary(native)}, reference {_summary(reference)}"
    assert not wrong, "; ".join(f"{name} differs by {gap:.3g}" for name, gap in wrong.items())


def _improve_at_once(improver: Improver, work: Improvable) -> None:
    for _ in work.improve():
        pass


def _improve_never(improver: Improver, work: Improvable) -> None:
    pass


def _ended_in_time(text: str) -> Outcome:
    """Run it as native code until it is over or the user ends it."""
    sessions: list[Session] = []

    class Kept(Session):
        def __init__(self, *args, **kwargs):
            super().__init__(*args, **kwargs)
            sessions.append(self)

    timer = Timer(SECONDS, lambda: [session.end() for session in sessions])
    timer.start()
    try:
        with patch("tests.programs.execution.Session", Kept):
            return execute(text, "native", Path.cwd())
    finally:
        timer.cancel()


def _differences(one: Outcome, reference: Outcome) -> dict[str, float]:
    """Return what differs and how much, relative: a sampled variable, a final value, or the kind of the outcome."""
    if (kinds := (_kind(one), _kind(reference)))[0] != kinds[1]:
        return {KIND: math.inf}
    found = {}
    for number, (a, b) in enumerate(zip(one.runs, reference.runs, strict=True), 1):
        for k, name in enumerate(["t", *(column.name for column in a.columns)] if a.count else []):
            found[f"run {number}: {name}"] = difference(a.rows[: a.count, k], b.rows[: b.count, k])
    for name in one.quantities.keys() - UNREPEATABLE:
        found[name] = difference(one.quantities[name], reference.quantities[name])
    return found


def _kind(outcome: Outcome) -> object:
    """Return errors, samples and ends of the runs, and names: if these differ, numbers need not be compared."""
    return _summary(outcome), outcome.quantities.keys()


def _summary(outcome: Outcome) -> str:
    return f"errors {_codes(outcome)} runs {[(run.count, run.ended) for run in outcome.runs]}"


def _codes(outcome: Outcome) -> list[int]:
    return [problem.code for problem in outcome.error.diagnostics] if outcome.error else []
