"""`fit`: files are read, the search is made, its result is judged and told."""

from __future__ import annotations

from typing import TYPE_CHECKING, NoReturn

import numpy as np

from desire_tui.analysis.fit.curves import Curves, FailedRunError
from desire_tui.analysis.fit.estimates import estimates
from desire_tui.analysis.fit.measurements import data_sets, read_files
from desire_tui.analysis.fit.report import Fitted, report, sketch
from desire_tui.analysis.fit.request import read_request
from desire_tui.analysis.fit.solve import Problem, Solution, StoppedError, solve
from desire_tui.analysis.progress import unwatched
from desire_tui.analysis.unknowns import start_values
from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.integration.rules import rule_numbered

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from desire_tui.analysis.fit.request import Asked
    from desire_tui.analysis.progress import Progress
    from desire_tui.analysis.result import Result
    from desire_tui.analysis.subject import Subject
    from desire_tui.engine.data_files.data_file import DataFile

    Floats = NDArray[np.float64]


def analyse(subject: Subject, request: str, progress: Progress) -> Result:
    """Return the best parameters and how well they are known.

    DesireError 520: the request; 531 … 534: the files; 521: there are no data, they do not overlap the run, a
    parameter has no influence, the run fails where the search begins.
    """
    asked = read_request(request)
    return fit(subject, asked, read_files(subject, asked), progress)


def fit(subject: Subject, asked: Asked, files: Sequence[DataFile], progress: Progress) -> Result:
    """Fit to files that have been read."""
    model = subject.model
    for one in asked.unknowns:
        asked.request.known(one.name, {**model.parameters, **model.states}, "parameter or state", one.span)
    progress(None, "the run as it stands")
    names = {one.name for one in asked.unknowns}
    fixed = {name: value for name, value in subject.settings.items() if name not in names}
    span, step = program_run(subject, fixed)
    sets, notes = data_sets(files, asked, span)
    quantities = [pair.quantity for pair in asked.pairs]
    runs = model.sensitive_runs([one.name for one in asked.unknowns], dict.fromkeys(quantities))
    curves = [Curves(runs, one, quantities, span, fixed, step) for one in sets]
    start = start_values(subject, asked.unknowns)
    watch = _Watch(subject, progress)
    problem = Problem(asked.unknowns, curves, watch, asked.runs)
    _check_start(subject, problem, start)
    try:
        solution = solve(problem, problem.z_of(start), asked.loss)
    except StoppedError:
        best = problem.best_z if len(problem.best_z) else problem.z_of(start)
        solution = Solution(best, converged=False, said=f"ended after {problem.runs} runs")
    if not runs.is_exact:
        notes.append("derivatives are differences of runs: this model cannot be differentiated")
    fitted = _judged(problem, solution, start, asked)
    found = report(subject, asked, fitted, notes)
    found.is_partial = watch.is_stopped
    return found


def program_run(subject: Subject, fixed: Mapping[str, float]) -> tuple[tuple[float, float], float]:
    """Return from when to when the program's run goes, and its DT where that is constant, else 0."""
    states = subject.model.states
    initial = {name: value for name, value in fixed.items() if name in states}
    settings = {name: value for name, value in fixed.items() if name not in states}
    plain = subject.model.run(set=settings, initial=initial or None)
    step = plain.dt if rule_numbered(plain.rule).kind == "fixed" else 0.0
    return (plain.t0, plain.t0 + plain.tmax), step


def _judged(problem: Problem, solution: Solution, start: Floats, asked: Asked) -> Fitted:
    """Return the solution with its standard errors."""
    problem.go_on, problem.runs_most = (lambda _: True), problem.runs + 10 * len(problem.curves)
    if problem.estimates_sigma:
        problem.estimate_sigma(solution.z, robust=asked.loss != "linear")
    residuals, jacobian = problem.residuals(solution.z), problem.jacobian(solution.z)
    names = [one.name for one in problem.unknowns]
    judged = estimates(names, residuals, jacobian, asked.loss, sigma_known=not problem.estimates_sigma)
    return Fitted(problem, solution, start, residuals, judged)


def _check_start(subject: Subject, problem: Problem, start: Floats) -> None:
    """DesireError 521: the run fails where the search begins; something has no influence there."""
    z = problem.z_of(start)
    try:
        parts = problem.raw(z)
    except FailedRunError as failure:
        at = ", ".join(f"{name} = {value:g}" for name, value in problem.values(z).items())
        _fail(
            f"the run fails where the fit begins, at {at}: {failure.error}", "begin elsewhere: k = 2", subject
        )
    slopes = np.concatenate([by_z for *_, by_z in parts], axis=1)
    if not np.isfinite(slopes).all():
        _fail("the curves have no derivatives where the fit begins", "begin elsewhere: k = 2", subject)
    without = [one.name for one, row in zip(problem.unknowns, slopes, strict=True) if not row.any()]
    if without:
        quantities = ", ".join(dict.fromkeys(q for c in problem.curves for q in c.quantities))
        what = f"no influence on {quantities} at the times of the data"
        remedy = "leave it out, measure what it changes, or begin elsewhere"
        _fail(f"{', '.join(without)} cannot be identified: {what}", remedy, subject)


def _fail(what: str, remedy: str, subject: Subject) -> NoReturn:
    raise DesireError(Diagnostic("analysis-failed", None, {"what": what, "remedy": remedy}, subject.source))


class _Watch:
    """Tells how the fit goes on, with the curves as they are by now."""

    def __init__(self, subject: Subject, progress: Progress) -> None:
        self._subject, self._progress = subject, progress
        self.is_stopped = False

    def __call__(self, problem: Problem) -> bool:
        if self._progress is unwatched:
            return True
        so_far = sketch(self._subject, problem) if len(problem.best_z) else None
        told = f"sum of squares {problem.best:.6g} after {problem.runs} runs" if so_far else "begins"
        self.is_stopped = not self._progress(None, told, so_far)
        return not self.is_stopped
