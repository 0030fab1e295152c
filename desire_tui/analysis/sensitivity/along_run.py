"""`sensitivity k, r of x, v`: derivatives of curves by parameters and initial values, exact along the run."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from desire_tui.analysis.result import Result, Table
from desire_tui.analysis.sensitivity.bars import bars
from desire_tui.engine.graph.chart import Chart, Series

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.analysis.progress import Progress
    from desire_tui.analysis.request import Request
    from desire_tui.analysis.subject import Subject
    from desire_tui.api.sensitive_runs import SensitiveRun

    Floats = NDArray[np.float64]

ALL = "all"
NORMALISED = "normalised"
DIFFERENCES = "differences of runs: the program draws random numbers, learns or slides along a switch there"


class _Asked(NamedTuple):
    parameters: list[str]
    outputs: list[str]
    is_normalised: bool


def along_run(subject: Subject, asked: Request, progress: Progress) -> Result:
    """Return curves of ∂x/∂p, and which parameters matter most.

    A parameter's *influence* on x is the root of the mean square of p·∂x/∂p over the run, divided by the
    largest |x|: by how many percent x changes, typically, for one percent of p. DesireError: a name is not
    there; the run fails.
    """
    wanted = _read(subject, asked)
    progress(None, "the run with its derivatives")
    runs = subject.model.sensitive_runs(wanted.parameters, wanted.outputs)
    values = _values(subject, wanted.parameters)
    run = runs({**subject.settings, **values})
    if run.error is not None:
        raise run.error
    return _found(subject, wanted, run, values)


def _read(subject: Subject, asked: Request) -> _Asked:
    model = subject.model
    known = {**model.parameters, **model.states}
    parameters: list[str] = []
    if asked.take(ALL):
        parameters += list(model.parameters)
    else:
        while True:
            span = asked.span
            name = asked.name("the name of a parameter, or of a state for its initial value")
            asked.known(name, known, "parameter or state", span)
            if name in parameters:
                asked.fail(f"'{name}' is given twice", "", span)
            parameters.append(name)
            if not asked.take(","):
                break
    asked.expect("of")
    outputs = [asked.name("the name of a quantity")]
    while asked.take(","):
        outputs.append(asked.name("the name of a quantity"))
    is_normalised = bool(asked.take(NORMALISED))
    asked.end()
    return _Asked(parameters, outputs, is_normalised)


def _values(subject: Subject, names: list[str]) -> dict[str, float]:
    own = {**subject.model.states, **subject.model.parameters, **subject.settings}
    return {
        name: float(own[name]) for name in names if name in subject.settings or name in subject.model.states
    }


def _found(subject: Subject, wanted: _Asked, run: SensitiveRun, values: dict[str, float]) -> Result:
    own = {**subject.model.states, **subject.model.parameters, **subject.settings, **values}
    sizes = np.array([float(own[name]) for name in wanted.parameters])
    charts, tables, notes, ranked = [], [], [], []
    found: dict[str, object] = {"t": run.t, "parameters": list(wanted.parameters)}
    for number, output in enumerate(run.names):
        curve, derivatives = run.values[number], run.derivatives[:, number]
        relative = derivatives * np.where(sizes != 0.0, sizes, 1.0)[:, None] / (np.abs(curve).max() or 1.0)
        influence = np.sqrt(np.nanmean(relative**2, axis=1))
        order = np.argsort(-influence, kind="stable")
        found[output] = {
            "curve": curve,
            "derivatives": derivatives,
            "normalised": relative,
            "influence": influence,
        }
        shown = relative if wanted.is_normalised else derivatives
        over = f"p/max|{output}|·∂{output}/∂p" if wanted.is_normalised else f"∂{output}/∂p"
        curves = [Series(wanted.parameters[k], run.t, shown[k]) for k in order]
        charts.append(Chart(f"Sensitivity of {output}", "t", over, curves))
        ranked.append(
            bars(
                f"Influence on {output}", "influence", [wanted.parameters[k] for k in order], influence[order]
            )
        )
        tables.append(Table(f"influence on {output}", {
            "": [wanted.parameters[k] for k in order], "value": sizes[order].tolist(),
            "influence": influence[order].tolist(),
            f"∂{output}/∂p at the end": derivatives[order, -1].tolist(),
            "largest": derivatives[order, np.nanargmax(np.abs(derivatives), axis=1)[order]].tolist(),
        }))  # fmt: skip
        none = [wanted.parameters[k] for k in order if influence[k] == 0.0]
        if none:
            notes.append(f"{', '.join(none)}: no influence on {output}")
    if not run.is_exact:
        notes.append(DIFFERENCES)
    title = f"Sensitivity of {', '.join(run.names)} to {', '.join(wanted.parameters)}, {subject.name}"
    return Result(title, found, tables, charts + ranked, notes)
