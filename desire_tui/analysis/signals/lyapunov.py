"""`lyapunov`: how fast neighbouring orbits part, the exponents of Lyapunov.

The variational equations are integrated with the states (`Model.sensitive_runs`); after each short stretch
the tangents are made orthogonal again, and the logarithms of what they grew by are summed (Benettin, Galgani,
Giorgilli & Strelcyn 1980; the QR form of Eckmann & Ruelle 1985).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.analysis.request import Request
from desire_tui.analysis.result import Result, Table
from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.graph.chart import Chart, Series

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.analysis.progress import Progress
    from desire_tui.analysis.subject import Subject

    Floats = NDArray[np.float64]

EXAMPLE = "lyapunov for 1000 every 1 from 50"
_GROWTH = 20.0
"""Exponent by which tangents may grow or shrink before they are made orthogonal: seven digits are left."""
_SPANS = 20.0
_BATCHES = 20
_NORMAL_95 = 1.959963984540054
_SHOWN = 400
_STATES_MOST = 60


@dataclass
class _Sums:
    """Logarithms of growth (stretches, exponents) over the times at which they end."""

    times: list[float]
    logs: list[Floats]

    def exponents(self, begin: float) -> Floats:
        """Return the running estimates, (stretches, exponents)."""
        grown = np.cumsum(np.array(self.logs), axis=0)
        return np.asarray(grown / (np.array(self.times)[:, None] - begin))


def analyse(subject: Subject, request: str, progress: Progress) -> Result:
    """Return the exponents, with 95 % intervals from the means of parts.

    DesireError 520: what is asked; 521: too many states; others: the run fails, derivatives are not there.
    """
    spans = _read(request)
    model = subject.model
    names = tuple(model.states)
    if not 0 < len(names) <= _STATES_MOST:
        what = f"the program has {len(names)} states, and as many exponents: 1 to {_STATES_MOST} are computed"
        facts = {"what": what, "remedy": "a smaller model"}
        raise DesireError(Diagnostic("analysis-failed", None, facts, subject.source))
    progress(None, "run")
    first = model.run(set=subject.settings)
    if first.error is not None:
        raise first.error
    span = float(first.t[-1] - first.t[0])
    begin = float(first.t[-1])
    state = np.asarray(first.state)
    runs = model.sensitive_runs(names, names)

    def stretch(t: float, x: Floats, length: float) -> tuple[float, Floats, Floats]:
        made = runs(
            {**subject.settings, **dict(zip(names, x.tolist(), strict=True))}, samples=2, t=(t, t + length)
        )
        if made.error is not None:
            raise made.error
        places = [made.names.index(name) for name in names]
        return float(made.t[-1]), made.values[places, -1], made.derivatives[:, places, -1].T

    if (wanted := spans.get("from")) is not None and wanted > begin:
        begin, state, _ = stretch(begin, state, wanted - begin)
    length = spans.get("every") or _length(subject, begin, state, span)
    count = max(round(spans.get("for", _SPANS * span) / length), 2)
    sums, basis, t, is_partial = _Sums([], []), np.eye(len(names)), begin, False
    for number in range(count):
        t, state, growth = stretch(t, state, length)
        basis, upper = np.linalg.qr(growth @ basis)
        with np.errstate(divide="ignore"):
            sums.times.append(t)
            sums.logs.append(np.log(np.abs(np.diag(upper))))
        if number % 16 == 0 and number:
            told = ", ".join(f"{value:.4g}" for value in sums.exponents(begin)[-1][:4])
            if not progress(number / count, told, _result(subject, sums, begin, exact=runs.is_exact)):
                is_partial = True
                break
    found = _result(subject, sums, begin, exact=runs.is_exact)
    found.is_partial = is_partial
    return found


def _read(request: str) -> dict[str, float]:
    asked = Request(request, EXAMPLE)
    found: dict[str, float] = {}
    while not asked.is_done:
        word, span = asked.expect("for", "every", "from"), asked.span
        found[word] = asked.number("a time")
        if word != "from" and found[word] <= 0.0:
            asked.fail(f"{word} {found[word]:g}: a time greater than 0 is meant", f"{word} 10", span)
    return found


def _length(subject: Subject, t: float, x: Floats, span: float) -> float:
    """Return how long a tangent may be followed before it is made orthogonal again."""
    poles = np.linalg.eigvals(subject.model.jacobian(t, x, **subject.settings))
    fastest = float(np.abs(poles.real).max())
    return min(span, _GROWTH / fastest) if fastest > 0 else span


def _result(subject: Subject, sums: _Sums, begin: float, *, exact: bool) -> Result:
    running = sums.exponents(begin)
    order = np.argsort(-running[-1])
    running = running[:, order]
    exponents = running[-1]
    times = np.array(sums.times)
    margins = _margins(np.array(sums.logs)[:, order] / np.diff(times, prepend=begin)[:, None])
    numbers = [str(k + 1) for k in range(len(exponents))]
    table = Table("", {"exponent": numbers, "value": exponents.tolist(), "± 95 %": margins.tolist()})
    shown = np.unique(np.linspace(0, len(times) - 1, _SHOWN).astype(int))
    series = [Series(f"exponent {name}", times[shown], running[shown, k]) for k, name in enumerate(numbers)]
    notes = [
        f"their sum is {exponents.sum():.8g}, the mean divergence",
        f"dimension of the attractor (Kaplan and Yorke): {dimension(exponents):.4g}",
    ]
    if not exact:
        notes.append("by differences of neighbouring runs: the equations cannot be differentiated")
    return Result(
        f"Lyapunov exponents over {times[-1] - begin:g}, {subject.name}",
        {"exponents": exponents, "margins": margins, "dimension": dimension(exponents), "t": times,
         "running": running},
        [table], [Chart("Lyapunov exponents so far", "t", "exponent", series)], notes,
    )  # fmt: skip


def _margins(rates: Floats) -> Floats:
    """Return 95 % margins of the means of rates that follow each other: from the means of 20 parts."""
    if len(rates) < 2 * _BATCHES:
        return np.full(rates.shape[1], np.nan)
    usable = len(rates) // _BATCHES * _BATCHES
    means = rates[len(rates) - usable :].reshape(_BATCHES, -1, rates.shape[1]).mean(axis=1)
    return np.asarray(_NORMAL_95 * means.std(axis=0, ddof=1) / np.sqrt(_BATCHES))


def dimension(exponents: Floats) -> float:
    """Return the dimension of an attractor with these exponents, the greatest first (Kaplan & Yorke 1979)."""
    sums = np.cumsum(exponents)
    whole = int(np.sum(sums >= 0.0))
    if whole == 0 or whole == len(exponents):
        return float(whole)
    return whole + float(sums[whole - 1] / abs(exponents[whole]))
