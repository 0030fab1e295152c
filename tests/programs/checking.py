"""Holds an outcome to a program's expectations, and two outcomes to each other."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from desire_tui.engine.runtime.run_record import RunRecord
    from tests.programs.execution import Outcome
    from tests.programs.expectations import Check, Expectations


def peak(x: np.ndarray, t: np.ndarray) -> float:
    """Return the maximum between samples: the top of a quartic through the five around the largest."""
    k = int(np.argmax(x))
    assert 2 <= k <= len(x) - 3, "the largest sample stands at the border"
    quartic = np.polynomial.Polynomial.fit(t[k - 2 : k + 3] - t[k], x[k - 2 : k + 3], 4)
    return float(quartic(np.linspace(t[k - 1] - t[k], t[k + 1] - t[k], 20001)).max())


FUNCTIONS = {
    "first": lambda x: float(x[0]),
    "last": lambda x: float(x[-1]),
    "nth": lambda x, k: float(x[k - 1]),
    "list": lambda *x: np.array(x[0] if len(x) == 1 else x, dtype=float),
    "changes": lambda x: int(np.count_nonzero(np.diff(x))),
    "max": np.max, "min": np.min, "sum": np.sum, "mean": np.mean, "argmin": np.argmin, "argmax": np.argmax,
    "inf": math.inf, "nan": math.nan, "diff": np.diff, "abs": np.abs, "sqrt": np.sqrt, "exp": np.exp, "sin": np.sin, "cos": np.cos, "log": np.log,
    "pi": math.pi, "PI": math.pi, "values": lambda x: x.data,
}  # fmt: skip


class Elements:
    """An array with subscripts from 1, as in the language."""

    def __init__(self, data: np.ndarray) -> None:
        self.data = data

    def __getitem__(self, index: int | tuple[int, ...]) -> float:
        places = index if isinstance(index, tuple) else (index,)
        return self.data[tuple(place - 1 for place in places)]


class ColumnFamily:
    """`V` where the run shows `V[40]`: the subscript finds the column."""

    def __init__(self, name: str, run: RunRecord) -> None:
        self.name, self.run = name, run

    def __getitem__(self, index: int | tuple[int, ...]) -> np.ndarray:
        places = index if isinstance(index, tuple) else (index,)
        wanted = f"{self.name}[{','.join(map(str, places))}]"
        for column in self.run.columns:
            if column.name.replace(" ", "") == wanted:
                return self.run.values(column.name)
        raise KeyError(wanted)


_OF_A_RUN = re.compile(r"\b(?:at|peak)\(")
"""Words that look at samples: without `run n:` at those of the last run."""


class Names(dict[str, object]):
    """What an expectation's names mean: columns of its run first, then final quantities, then words of our own."""

    def __init__(self, outcome: Outcome, run: RunRecord | None) -> None:
        super().__init__(FUNCTIONS)
        self.update(runs=len(outcome.runs), points=outcome.points)
        if run is not None:
            t = run.t
            self.update(ended=run.ended, count=len(t), points=len(t), steps=run.steps, rejected=run.rejected)
            self.update(calls=run.derivative_calls, jacobians=run.jacobian_calls)
            self.update(least=run.dt_least, most=run.dt_most)
            self.update(peak=lambda x: peak(x, t), at=lambda x, when: float(np.interp(when, t, x)))
        self.update(
            {name: Elements(v) if isinstance(v, np.ndarray) else v for name, v in outcome.quantities.items()}
        )
        if run is None:
            return
        for column in run.columns:
            if "[" in column.name:
                family = column.name.split("[")[0]
                self[family] = ColumnFamily(family, run)
        for column in run.columns:
            self[column.name] = run.values(column.name)
        self.update(t=run.t, scale=run.scale)


def check(expected: Check, outcome: Outcome) -> str | None:
    """Return what is wrong, or None."""
    try:
        return _check(expected, outcome)
    except Exception as error:  # noqa: BLE001 - whatever goes wrong in an expectation's expression is shown with it
        return f"row {expected.row}: {expected.text}\n    {error!r}"


def _check(expected: Check, outcome: Outcome) -> str | None:
    if expected.run is not None and len(outcome.runs) < abs(expected.run):
        return f"row {expected.row}: there were only {len(outcome.runs)} runs"
    run = None
    if expected.run is not None:
        run = outcome.runs[expected.run - 1 if expected.run > 0 else expected.run]
    elif _OF_A_RUN.search(expected.left) and outcome.runs:
        run = outcome.runs[-1]
    names = Names(outcome, run)
    left, right = _value(expected.left, names), _value(expected.right, names)
    if expected.op == "<":
        met = bool(np.all(left < right))
    elif expected.op == ">":
        met = bool(np.all(left > right))
    elif isinstance(right, str):
        met = left == right
    else:
        finite = np.isfinite(right)
        bound = expected.tolerance * (
            np.max(np.abs(right), where=finite, initial=0.0) if expected.relative else 1.0
        )
        met = np.shape(left) == np.shape(right) and bool(
            np.all(np.isclose(left, right, rtol=0.0, atol=max(bound, 1e-13), equal_nan=True))
        )
    return None if met else f"row {expected.row}: {expected.text}\n    but it is {_shown(left)}"


def _value(text: str, names: Names) -> object:
    value = eval(text.replace("^", "**"), {"__builtins__": {}}, names)
    return np.array(value, dtype=float) if isinstance(value, list) else value


def _shown(value: object) -> str:
    if isinstance(value, np.ndarray) and value.size > 12:
        return f"array of {value.size}"
    return repr(value) if isinstance(value, str | np.ndarray) else f"{value:.13g}"


def disagreements(native: Outcome, reference: Outcome, expected: Expectations) -> list[str]:
    """Return where two back ends differ by more than the program allows."""
    wrong = []
    if [e.key for e in _problems(native)] != [e.key for e in _problems(reference)]:
        wrong.append(f"errors differ: {native.error} | {reference.error}")
    gaps = [
        [w.message for w in outcome.warnings if w.key == "sample-not-finite"]
        for outcome in (native, reference)
    ]
    if gaps[0] != gaps[1]:
        wrong.append(f"warnings differ: {gaps[0]} | {gaps[1]}")
    if len(native.runs) != len(reference.runs):
        return [*wrong, f"{len(native.runs)} runs, reference {len(reference.runs)}"]
    for number, (a, b) in enumerate(zip(native.runs, reference.runs, strict=True), 1):
        if a.count != b.count or a.ended != b.ended:
            wrong.append(f"run {number}: {a.count} samples, {a.ended}; reference {b.count}, {b.ended}")
            continue
        for k, name in enumerate(["t", *(column.name for column in a.columns)] if a.count else []):
            worst = difference(a.rows[: a.count, k], b.rows[: b.count, k])
            if not worst <= expected.compare:
                wrong.append(f"run {number}: {name} differs by {worst:.3g}")
    for name in native.quantities.keys() | reference.quantities.keys():
        if name not in native.quantities or name not in reference.quantities:
            wrong.append(f"{name} is defined by one back end only")
            continue
        worst = difference(native.quantities[name], reference.quantities[name])
        if not worst <= expected.compare and name not in UNREPEATABLE:
            wrong.append(f"{name} differs by {worst:.3g}")
    if expected.compare <= 1e-12 and native.console != reference.console:
        wrong.append(f"console differs: {native.console!r} | {reference.console!r}")
    return wrong


UNREPEATABLE = frozenset({"started", "elapsed"})
"""Quantities that hold clock times."""


def difference(a: object, b: object) -> float:
    """Return the largest difference relative to the largest finite value; 0 where both are the same inf or nan."""
    a, b = np.asarray(a, dtype=complex), np.asarray(b, dtype=complex)
    if a.shape != b.shape:
        return math.inf
    other = ~((a == b) | (np.isnan(a) & np.isnan(b)))
    if not other.any():
        return 0.0
    with np.errstate(all="ignore"):
        gaps = np.abs(a - b)[other]
    if not np.isfinite(gaps).all():
        return math.inf
    sizes = np.abs(np.concatenate([a.ravel(), b.ravel()]))
    return float(np.max(gaps) / np.max(sizes[np.isfinite(sizes)]))


def _problems(outcome: Outcome) -> list:
    return list(outcome.error.diagnostics) if outcome.error else []
