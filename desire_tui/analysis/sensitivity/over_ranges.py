"""`sensitivity global k in [1, 2], r in [0, 1] of x[end]`: which of several quantities decides, over ranges.

Sobol' indices (Saltelli et al., Comput. Phys. Commun. 181, 2010) or the elementary effects of Morris
(Technometrics 33, 1991) by SALib; the study engine makes the runs.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from desire_tui.analysis.libraries import needed
from desire_tui.analysis.result import Result, Table
from desire_tui.analysis.sensitivity.bars import bars
from desire_tui.analysis.unknowns import read_unknowns
from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.graph.chart import Chart, Series
from desire_tui.studies.design import Design
from desire_tui.studies.keep import kept
from desire_tui.studies.study import Study

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from desire_tui.analysis.progress import Progress
    from desire_tui.analysis.request import Request
    from desire_tui.analysis.subject import Subject
    from desire_tui.analysis.unknowns import Unknown
    from desire_tui.studies.study import Progress as StudyProgress

    Floats = NDArray[np.float64]

WHAT = "global sensitivity"
RUNS = 8192
_GROUPS_LEAST = 8
_LEVELS = 4
_METHODS = ("sobol", "morris")


@dataclass(frozen=True)
class _Asked:
    unknowns: list[Unknown]
    keep: str
    method: str
    runs: int
    seed: int

    @property
    def group(self) -> int:
        """How many runs belong together: those of one point of the sample, of one trajectory."""
        return len(self.unknowns) + (2 if self.method == "sobol" else 1)

    @property
    def problem(self) -> dict[str, Any]:
        """What is varied, as SALib is told; logarithmic scales as logarithms."""
        ends = [(one.low, one.high) for one in self.unknowns]
        bounds = [
            [float(np.log(low)), float(np.log(high))] if one.is_log else [low, high]
            for one, (low, high) in zip(self.unknowns, ends, strict=True)
        ]
        return {"num_vars": len(bounds), "names": [one.name for one in self.unknowns], "bounds": bounds}


def over_ranges(subject: Subject, asked: Request, progress: Progress) -> Result:
    """Return indices of each quantity that is kept. DesireError: the request; hardly a run succeeds."""
    wanted = _read(asked)
    sample = _sample(wanted)
    values = np.where([one.is_log for one in wanted.unknowns], np.exp(np.minimum(sample, 700.0)), sample)
    names = tuple(one.name for one in wanted.unknowns)
    task = subject.task(wanted.keep, names)
    study = Study(task, Design({}, None, {name: values[:, k] for k, name in enumerate(names)}))
    is_stopped = False

    def told(at: StudyProgress) -> bool:
        nonlocal is_stopped
        is_stopped = not progress(at.made / at.runs, f"{at.made} of {at.runs} runs")
        return not is_stopped

    study.run(progress=told)
    made = study.result()
    outputs = {item.label: np.asarray(made[item.label].values) for item in kept(wanted.keep).items}
    found = _found(subject, wanted, sample, outputs)
    found.is_partial = is_stopped
    if study.store.failures.count:
        found.notes += study.store.failures.lines()
    return found


def _read(asked: Request) -> _Asked:
    unknowns = read_unknowns(asked, "of")
    for one in unknowns:
        if not one.is_bounded:
            asked.fail(f"the range of {one.name} is missing", f"{one.name} in [0, 1]", one.span)
    if len(unknowns) < 2:
        asked.fail("one quantity alone decides everything: name two or more", "", unknowns[0].span)
    asked.expect("of")
    span = asked.span
    keep = asked.expression(*_METHODS, "runs", "seed")
    method, runs, seed = "sobol", RUNS, 0
    items = _kept(asked, keep, span)
    while not asked.is_done:
        word = asked.expect(*_METHODS, "runs", "seed")
        if word in _METHODS:
            method = word
            continue
        if word == "runs":
            runs = asked.whole(4 * _GROUPS_LEAST, f"runs {RUNS}")
        else:
            seed = asked.whole(0, "seed 1")
    return _Asked(unknowns, items, method, runs, seed)


def _kept(asked: Request, text: str, span: Any) -> str:
    """Return what the study keeps: names alone stand for their last values. DesireError 510, 520."""
    parts = []
    for part in kept_parts(text):
        try:
            (item,) = kept(part).items
        except DesireError:
            part = f"{part}[end]"  # noqa: PLW2901 - `x` is `x[end]`
            (item,) = kept(part).items
        if item.size != 1:
            asked.fail(f"'{part}' is not one number of a run", "x[end], max(x), x@2", span)
        parts.append(part)
    return ", ".join(parts)


def kept_parts(text: str) -> list[str]:
    """Divide `x[end], max(a, b)` at its commas outside brackets."""
    depth, parts = 0, [""]
    for mark in text:
        depth += (mark in "([") - (mark in ")]")
        if mark == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += mark
    return [part.strip() for part in parts]


def _sample(wanted: _Asked) -> Floats:
    """Return a row for each run."""
    groups = max(wanted.runs // wanted.group, _GROUPS_LEAST)
    if wanted.method == "morris":
        sampler = needed("SALib.sample.morris", WHAT)
        rows = sampler.sample(wanted.problem, groups, num_levels=_LEVELS, seed=wanted.seed)
    else:
        sampler = needed("SALib.sample.sobol", WHAT)
        groups = 1 << (groups.bit_length() - 1)  # Sobol' sequences are balanced at powers of 2
        rows = sampler.sample(wanted.problem, groups, calc_second_order=False, seed=wanted.seed)
    return np.asarray(rows, dtype=np.float64)


def _found(subject: Subject, wanted: _Asked, sample: Floats, outputs: Mapping[str, Floats]) -> Result:
    charts, tables, notes = [], [], []
    values: dict[str, Any] = {"runs": len(sample)}
    names = [one.name for one in wanted.unknowns]
    for label, numbers in outputs.items():
        groups = numbers.reshape(-1, wanted.group)
        whole = np.asarray(np.isfinite(groups).all(axis=1))
        if whole.sum() < _GROUPS_LEAST:
            facts = {"what": f"{label}: only {int(whole.sum())} of {len(whole)} groups of runs are complete",
                     "remedy": "smaller ranges, or `desire study` to see which runs fail"}  # fmt: skip
            raise DesireError(Diagnostic("analysis-failed", None, facts, subject.source))
        if not whole.all():
            notes.append(f"{label}: {int((~whole).sum())} of {len(whole)} groups of runs are left out")
        rows = np.repeat(whole, wanted.group)
        if np.ptp(numbers[rows]) == 0.0:
            facts = {"what": f"{label} is {numbers[rows][0]:g} in all runs: nothing has an influence",
                     "remedy": "keep something that the quantities change"}  # fmt: skip
            raise DesireError(Diagnostic("analysis-failed", None, facts, subject.source))
        indices = _indices(wanted, sample[rows], numbers[rows])
        values[label] = indices
        first = next(iter(indices.values()))
        order = np.argsort(-np.abs(indices["ST" if wanted.method == "sobol" else "mu*"]), kind="stable")
        columns = {name: np.asarray(column)[order].tolist() for name, column in indices.items()}
        tables.append(Table(label, {"": [names[k] for k in order], **columns}))
        ranked = [names[k] for k in order]
        if wanted.method == "sobol":
            charts.append(bars(f"Share in the variance of {label}, interactions included", "total index",
                               ranked, indices["ST"][order]))  # fmt: skip
            charts.append(bars(f"Share in the variance of {label}, alone", "first-order index",
                               ranked, first[order]))  # fmt: skip
        else:
            points = [
                Series(names[k], indices["mu*"][k : k + 1], indices["sigma"][k : k + 1], "points")
                for k in order
            ]
            charts.append(Chart(f"Effects on {label}", "mu*: how large", "sigma: how uneven", points))
    what = "Sobol' indices" if wanted.method == "sobol" else "Elementary effects (Morris)"
    title = f"{what} of {', '.join(outputs)}, {subject.name} ({len(sample)} runs)"
    return Result(title, values, tables, charts, notes)


def _indices(wanted: _Asked, sample: Floats, numbers: Floats) -> dict[str, Floats]:
    """Return indices by name, a number for each quantity; `±` is half of a 95 % interval."""
    if wanted.method == "sobol":
        found = needed("SALib.analyze.sobol", WHAT).analyze(
            wanted.problem, numbers, calc_second_order=False, seed=wanted.seed
        )
        words = {"S1": "S1", "S1 ±": "S1_conf", "ST": "ST", "ST ±": "ST_conf"}
    else:
        found = needed("SALib.analyze.morris", WHAT).analyze(
            wanted.problem, sample, numbers, num_levels=_LEVELS, seed=wanted.seed
        )
        words = {"mu*": "mu_star", "mu* ±": "mu_star_conf", "mu": "mu", "sigma": "sigma"}
    return {name: np.asarray(found[word], dtype=np.float64) for name, word in words.items()}
