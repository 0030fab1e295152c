"""Runs as plain matplotlib curves, for callers that go on drawing, and as pictures for notebooks."""

from __future__ import annotations

from base64 import b64encode
from html import escape
from io import BytesIO
from typing import TYPE_CHECKING, Any

from desire_tui.engine.outputs.sampled_run import (
    CurveData,
    SampledRun,
    curve_named,
    curves_over_t,
    samples,
)

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from matplotlib.axes import Axes

    from desire_tui.engine.runtime.point_set import PointSet

CURVES_MOST = 12
"""In a picture that nobody asked for."""
_PARAMETERS_MOST = 20


def plot_run(run: SampledRun, names: Sequence[str], ax: Axes | None, style: Mapping[str, Any]) -> Axes:
    """Draw a run's curves on `ax`, or on a new figure. KeyError: a name that was not recorded."""
    if ax is None:
        from matplotlib import pyplot as plt

        ax = plt.subplots(layout="constrained")[1]
    points = [one for one in run.points if not names or one.name in names]
    measured = {one.name for one in points}
    curves = [curve_named(run, name) for name in names if name not in measured]
    _draw(ax, run, curves if names else _shown(run), style)
    _draw_points(ax, points)
    return ax


def plot_runs(
    runs: Sequence[SampledRun], names: Sequence[str], ax: Axes | None, style: Mapping[str, Any]
) -> Axes:
    """Draw several runs on the same axes; a curve has the same colour in all of them."""
    if ax is None:
        from matplotlib import pyplot as plt

        ax = plt.subplots(layout="constrained")[1]
    for number, run in enumerate(runs):
        ax.set_prop_cycle(None)
        plot_run(run, names, ax, style if number == 0 else {**style, "label": "_"})
    return ax


def run_png(runs: Sequence[SampledRun]) -> bytes:
    """Return a picture of runs as PNG; curves of the same name have the same colour."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.4, 4.0), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots()
    for number, run in enumerate(runs):
        curves = _shown(run)[:CURVES_MOST]
        axes.set_prop_cycle(None)
        _draw(axes, run, curves, {} if number == 0 else {"label": "_"})
    _draw_points(axes, [one for run in runs for one in run.points])
    file = BytesIO()
    figure.savefig(file, format="png", dpi=100)
    return file.getvalue()


def run_html(runs: Sequence[SampledRun], text: str, parameters: Mapping[str, float]) -> str:
    """Return one line about runs, their picture and parameters."""
    shown = [f"{name} = {value:g}" for name, value in list(parameters.items())[:_PARAMETERS_MOST]]
    if len(parameters) > _PARAMETERS_MOST:
        shown.append("…")
    picture = ""
    if any(len(run.t) and curves_over_t(run) for run in runs):
        data = b64encode(run_png(runs)).decode("ascii")
        picture = f'<img alt="{escape(text)}" src="data:image/png;base64,{data}">'
    below = f"<div><small>{escape(', '.join(shown))}</small></div>" if shown else ""
    return f"<div><code>{escape(text)}</code></div>{picture}{below}"


def _shown(run: SampledRun) -> list[CurveData]:
    """Return what is drawn unless somebody asks for more: where curves are over others, only those."""
    curves = curves_over_t(run)
    return [curve for curve in curves if curve.x is not None] or curves


def _draw_points(axes: Axes, points: Sequence[PointSet]) -> None:
    """Draw what was measured as markers, each name once."""
    there = set(axes.get_legend_handles_labels()[1])
    for one in points:
        if one.name not in there:
            there.add(one.name)
            axes.plot(one.x, one.y, "o", label=one.name)
    if points:
        axes.legend()


def _draw(axes: Axes, run: SampledRun, curves: Sequence[CurveData], style: Mapping[str, Any]) -> None:
    for curve in curves:
        over = run.t if curve.x is None else samples(run, curve.x)
        axes.plot(over, curve.values, **{"label": curve.name, **style})
    over_names = {curve.x or "t" for curve in curves}
    if len(over_names) == 1:
        axes.set_xlabel(over_names.pop())
    if len(curves) == 1:
        axes.set_ylabel(curves[0].name)
    elif axes.get_legend_handles_labels()[1]:
        axes.legend()
