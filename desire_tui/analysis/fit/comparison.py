"""`measured x ~ position from 'measured.csv'`: measured points over the program's curves."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.analysis.fit.analysis import program_run
from desire_tui.analysis.fit.curves import Curves
from desire_tui.analysis.fit.measurements import data_sets, read_files
from desire_tui.analysis.fit.report import points
from desire_tui.analysis.fit.request import read_comparison
from desire_tui.analysis.result import Result, Table
from desire_tui.engine.graph.chart import Chart, Series

if TYPE_CHECKING:
    from desire_tui.analysis.progress import Progress
    from desire_tui.analysis.subject import Subject

_SAMPLES_LEAST = 401


def analyse(subject: Subject, request: str, progress: Progress) -> Result:
    """Return charts of curves with points, and of each pair the deviations: mean, root mean square, largest.

    `R^2` is the share of the points' variance that the curve explains. DesireError: as for a fit.
    """
    asked = read_comparison(request)
    files = read_files(subject, asked)
    progress(None, "the run as it stands")
    span, step = program_run(subject, subject.settings)
    sets, notes = data_sets(files, asked, span)
    quantities = [pair.quantity for pair in asked.pairs]
    runs = subject.model.sensitive_runs([], dict.fromkeys(quantities))
    charts, rows = [], []
    for data in sets:
        curves = Curves(runs, data, quantities, span, subject.settings, step)
        made = curves.drawn({}, _SAMPLES_LEAST)
        if made.error is not None:
            raise made.error
        for number, (one, found) in enumerate(zip(data.measured, curves.at_measurements({}), strict=True)):
            quantity = quantities[number]
            curve = Series(quantity, made.t, made.values[made.names.index(quantity)])
            charts.append(
                Chart(f"{quantity} and {data.name}", "t", quantity, [points(curves, number), curve])
            )
            off = one.y - found.values
            spread = float(np.sum((one.y - one.y.mean()) ** 2))
            rows.append({
                "": quantity, "file": data.name, "points": len(off), "mean": float(off.mean()),
                "root mean square": float(np.sqrt(np.mean(off**2))),
                "largest": float(off[np.argmax(np.abs(off))]),
                "R^2": 1.0 - float(off @ off) / spread if spread else np.nan,
            })  # fmt: skip
    table = Table("measured less computed", {name: [row[name] for row in rows] for name in rows[0]})
    return Result(f"Measurements and {subject.name}", {"deviations": rows}, [table], charts, notes)
