"""`linearise u -> y`: what is asked, where, and what is told of it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.analysis.equilibria.flow import Flow
from desire_tui.analysis.equilibria.newton import newton
from desire_tui.analysis.equilibria.system import System
from desire_tui.analysis.linear import responses
from desire_tui.analysis.linear.state_space import Place, StateSpace, state_space
from desire_tui.analysis.request import Request
from desire_tui.analysis.result import Result, Table
from desire_tui.analysis.samples import sampled
from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.graph.chart import Chart, Series

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from desire_tui.analysis.progress import Progress
    from desire_tui.analysis.subject import Subject
    from desire_tui.engine.outputs.run import Run

    Floats = NDArray[np.float64]

EXAMPLE = "linearise u -> y at steady"
_STILL = 1e-6
"""At an equilibrium states change by no more than this part of their size in a unit of time."""
_MATRICES_MOST = 12


@dataclass(frozen=True)
class _Asked:
    inputs: list[str]
    outputs: list[str]
    at: str | float = "end"
    along: int = 0


def analyse(subject: Subject, request: str, progress: Progress) -> Result:
    """Return the linear system near a place, or the poles at places along the run.

    DesireError 520: what is asked is not written so, or not there; 521: there is no such place.
    """
    asked = _read(subject, request)
    progress(None, "run")
    if asked.along:
        return _along(subject, asked, progress)
    place = _place(subject, asked)
    progress(None, "differentiate")
    matrices = state_space(subject, asked.inputs, asked.outputs, place)
    poles = np.linalg.eigvals(matrices.a).astype(complex)
    notes = [f"{place.said}: {responses.stability(poles)}"]
    slopes = subject.model.rhs(place.t, place.x, **subject.settings)
    if np.any(np.abs(slopes) > _STILL * np.maximum(np.abs(place.x), 1.0)):
        fastest = int(np.argmax(np.abs(slopes)))
        still = f"d/dt {matrices.states[fastest]} = {slopes[fastest]:.4g}"
        notes.append(f"no equilibrium: {still}; 'at steady' goes to one")
    tables, charts = [responses.pole_table(poles)], []
    if asked.inputs:
        system = responses.system_of(matrices)
        tables.append(responses.margin_table(system, matrices))
        charts = responses.charts(system, matrices)
    if len(matrices.states) <= _MATRICES_MOST:
        tables += _matrix_tables(matrices)
    what = f"{', '.join(asked.inputs)} -> {', '.join(asked.outputs)}" if asked.inputs else "poles"
    return Result(
        f"Linear system {what} of {subject.name}",
        {"A": matrices.a, "B": matrices.b, "C": matrices.c, "D": matrices.d, "poles": poles,
         "states": list(matrices.states), "t": place.t, "x": place.x},
        tables, charts, notes,
    )  # fmt: skip


def _read(subject: Subject, request: str) -> _Asked:
    asked = Request(request, EXAMPLE)
    model = subject.model
    inputs: list[str] = []
    outputs: list[str] = []
    if asked.peek() not in ("at", "along", "from", ""):
        inputs = _names(asked, model.parameters, "parameter, which an input has to be")
        asked.expect("->")
        outputs = _names(asked, None, "")
    at: str | float = "end"
    along = 0
    while not asked.is_done:
        word = asked.expect("at", "along", "from")
        if word == "along":
            along = asked.whole(2, "along 20")
        elif word == "from":
            asked.expect("here")
            at = "here"
            if subject.here is None:
                asked.fail("there is no 'here' without a desktop", "at end", None)
            missing = [name for name in model.states if name not in subject.here]
            if missing:
                asked.fail(f"{', '.join(missing)} has no value now", "run the program first: F5", None)
        elif asked.take("t"):
            asked.expect("=")
            at = asked.number("a time")
        else:
            at = asked.expect("start", "end", "steady")
    return _Asked(inputs, outputs, at, along)


def _names(asked: Request, known: Mapping[str, float] | None, what: str) -> list[str]:
    found = []
    while True:
        span = asked.span
        name = asked.name("a quantity's name")
        if known is not None:
            asked.known(name, known, what, span)
        found.append(name)
        if not asked.take(","):
            return found


def _place(subject: Subject, asked: _Asked) -> Place:
    model, settings = subject.model, subject.settings
    if asked.at == "here":
        assert subject.here is not None
        x = np.array([subject.here[name] for name in model.states])
        return Place(subject.here.get("t", 0.0), x, "where the states are now")
    states = tuple(model.states)
    run = model.run(set=settings, record=states)
    if run.error is not None:
        raise run.error
    if asked.at == "start":
        return Place(float(run.t[0]), _states(run, states, 0), f"t = {run.t[0]:g}, where the run begins")
    if isinstance(asked.at, float):
        if not run.t[0] <= asked.at <= run.t[-1]:
            facts = {"what": f"t = {asked.at:g} is outside the run, {run.t[0]:g} to {run.t[-1]:g}",
                     "remedy": f"at t = {run.t[-1]:g}"}  # fmt: skip
            raise DesireError(Diagnostic("analysis-failed", None, facts, subject.source))
        if asked.at > run.t[0]:  # samples beside it would have to be joined by straight lines
            to_there = (float(run.t[0]), asked.at)
            run = model.run(set={**settings, "NN": 2.0}, t=to_there, record=states, check=True)
        return Place(float(run.t[-1]), np.asarray(run.state), f"t = {run.t[-1]:g}")
    end = Place(float(run.t[-1]), np.asarray(run.state), f"t = {run.t[-1]:g}, where the run ends")
    return _steady(subject, end) if asked.at == "steady" else end


def _states(run: Run, states: tuple[str, ...], number: int) -> Floats:
    return np.array([run[name][number] for name in states])


def _steady(subject: Subject, near: Place) -> Place:
    """Return the equilibrium that Newton's method comes to from the run's end. DesireError 521: to none."""
    flow = Flow(subject)
    system = System(flow, near.x)
    solution = newton(system, system.place(near.x), {})
    if solution.outcome != "found":
        facts = {"what": f"no equilibrium is found from where the run ends ({solution.outcome})",
                 "remedy": "steady all in x = [-2, 2] looks in a box; at end takes the end"}  # fmt: skip
        raise DesireError(Diagnostic("analysis-failed", None, facts, subject.source))
    x = system.states(solution.z)
    shown = ", ".join(f"{name} = {value:.6g}" for name, value in zip(flow.names[:6], x, strict=False))
    return Place(near.t, x, f"equilibrium {shown}{', …' if len(x) > 6 else ''}")


def _along(subject: Subject, asked: _Asked, progress: Progress) -> Result:
    """Return the poles at places along the run."""
    model, settings = subject.model, subject.settings
    states = tuple(model.states)
    run = sampled(subject, states)
    numbers = np.unique(np.linspace(0, len(run.t) - 1, asked.along).astype(int))
    poles, series = [], []
    for count, number in enumerate(numbers):
        if not progress(count / len(numbers), f"t = {run.t[number]:g}"):
            break
        jacobian = model.jacobian(float(run.t[number]), _states(run, states, number), **settings)
        found = np.linalg.eigvals(jacobian).astype(complex)
        poles.append(found)
        part = count / max(len(numbers) - 1, 1)
        series.append(Series(f"t = {run.t[number]:.4g}", found.real, found.imag, "points", part=part))
    times = run.t[numbers[: len(poles)]]
    table = Table("poles along the run", {
        "t": times.tolist(), "rightmost": [float(p.real.max()) for p in poles],
        "its frequency": [float(abs(p[np.argmax(p.real)].imag)) for p in poles],
    })  # fmt: skip
    right = [Series("rightmost real part", times, np.array([p.real.max() for p in poles]))]
    return Result(
        f"Poles along the run of {subject.name}", {"t": times, "poles": np.array(poles)}, [table],
        [Chart("Poles along the run", "real", "imaginary", series),
         Chart("Rightmost pole", "t", "real", right)],
        is_partial=len(poles) < len(numbers),
    )  # fmt: skip


def _matrix_tables(matrices: StateSpace) -> list[Table]:
    def table(title: str, rows: tuple[str, ...], columns: tuple[str, ...], values: Floats) -> Table:
        numbers = {name: values[:, k].tolist() for k, name in enumerate(columns)}
        return Table(title, {"": list(rows), **numbers})

    found = [table("A", matrices.states, matrices.states, matrices.a)]
    if matrices.inputs:
        found += [
            table("B", matrices.states, matrices.inputs, matrices.b),
            table("C", matrices.outputs, matrices.states, matrices.c),
            table("D", matrices.outputs, matrices.inputs, matrices.d),
        ]
    return found
