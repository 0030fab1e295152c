"""A graph as a picture, drawn by matplotlib (its Figure, never pyplot)."""

from __future__ import annotations

from contextlib import contextmanager
from io import BytesIO
from threading import Lock
from typing import TYPE_CHECKING, Any

from desire_tui.engine.data_classes import replace
from desire_tui.engine.graph.colors import BLACK, WHITE
from desire_tui.engine.graph.fit import WHOLE, Extent, limits, notice
from desire_tui.engine.graph.ticks import log_ticks, minor_log_ticks, minor_ticks, round_ticks, tick_labels
from desire_tui.engine.outputs.drawn_curves import (
    DASHES,
    MARKERS,
    POINT_WIDTH,
    curve_tint,
    draw_curve,
    draw_points,
    fill_band,
    tint,
)
from desire_tui.engine.outputs.picture_options import FOR_PAPER, PictureOptions
from desire_tui.engine.outputs.shown_arrays import FONT, draw_arrays, draw_cells

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from desire_tui.engine.graph.model import Graph
    from desire_tui.engine.outputs.picture_options import PictureStyle

    Tint = tuple[float, float, float]

_CHARACTERS = 11
"""So many of the font have room on an inch."""
_KEY_CHARACTERS = 6
"""Room that a key takes beside its name."""
_NAME_MOST = 40  # characters; a longer name of the ordinate stands in the caption
_SPINE = 2 * 72 / FOR_PAPER.dots_per_inch  # two dots: crisp
_drawing = Lock()  # matplotlib's settings are global, and two threads may draw at once


def png_of(graph: Graph, width: int, height: int) -> bytes:
    """Return a graph as a PNG of `width` × `height` dots."""
    wide = FOR_PAPER.inches[0]
    return picture_of(graph, "png", PictureOptions((wide, wide * height / width), width / wide))


def pdf_of(graphs: Sequence[Graph], options: PictureOptions = FOR_PAPER) -> bytes:
    """Return graphs as the content of one PDF file, a page each."""
    from matplotlib.backends.backend_pdf import PdfPages

    buffer = BytesIO()
    with _settings(), PdfPages(buffer) as pages:
        for graph in graphs:
            figure = _drawn(graph, options)
            pages.savefig(figure, dpi=options.dots_per_inch, facecolor=figure.get_facecolor())
    return buffer.getvalue()


def picture_of(graph: Graph, kind: str, options: PictureOptions = FOR_PAPER) -> bytes:
    """Return a graph as the content of a picture file; `kind` is a format of matplotlib (png, svg, pdf).

    It is drawn in memory: matplotlib's PDF writer cannot cope with a disk that is full.
    """
    buffer = BytesIO()
    with _settings():
        figure = _drawn(graph, options)
        figure.savefig(buffer, format=kind, dpi=options.dots_per_inch, facecolor=figure.get_facecolor())
    return buffer.getvalue()


@contextmanager
def _settings() -> Iterator[None]:
    """Draw alone, under our settings: no TeX, which can read files, and a `matplotlibrc` may ask for."""
    import logging
    import warnings

    logging.getLogger("matplotlib").setLevel(logging.ERROR)  # it reports that it fills its font cache
    from matplotlib import rc_context

    fixed = rc_context({
        "svg.fonttype": "none", "pdf.fonttype": 42, "agg.path.chunksize": 20000, "text.usetex": False,
    })  # fmt: skip
    with _drawing, fixed, warnings.catch_warnings():
        # labels that leave a very small picture no room for curves stand over them then
        warnings.filterwarnings("ignore", message="constrained_layout not applied")
        yield


def _drawn(graph: Graph, options: PictureOptions) -> Figure:
    return draw(graph if _in_own_colors(graph, options.style) else _on_paper(graph), options.inches)


def _in_own_colors(graph: Graph, style: PictureStyle | None) -> bool:
    return style == "screen" or (style is None and graph.has_own_colors)


def _on_paper(graph: Graph) -> Graph:
    return replace(graph, white=True, net=BLACK if graph.net is not None else None)


def draw(graph: Graph, inches: tuple[float, float] = FOR_PAPER.inches) -> Figure:
    """Return a graph as a figure: same window, colours, caption, keys and thickness as on the screen."""
    from matplotlib.figure import Figure

    ground = tint(WHITE if graph.white else BLACK, graph)
    ink = tint(BLACK if graph.white else 7, graph)
    figure = Figure(figsize=inches, facecolor=ground, layout="constrained")
    shown = [(array, values) for array in graph.shown if (values := array.latest()) is not None]
    if graph.cells is not None and shown:
        draw_cells(figure, figure.add_subplot(), shown[0][1], graph, graph.cells, ink)
        return figure
    if graph.frame.kind == "picture":
        draw_arrays(shown, [figure.add_subplot(1, len(shown), n + 1) for n in range(len(shown))], ink)
        return figure
    axes = figure.add_subplot()
    if shown:  # beside the curves
        columns = figure.add_gridspec(1, 1 + len(shown), width_ratios=[2 * len(shown), *[1] * len(shown)])
        axes.set_subplotspec(columns[0])
        draw_arrays(shown, [figure.add_subplot(columns[n + 1]) for n in range(len(shown))], ink)
    axes.set_facecolor(ground)
    extent = Extent(graph)
    extent.update()
    window = extent.view() if extent.is_fitted else WHOLE
    _style_axes(axes, graph, ink, limits(graph, window))
    for low, high in graph.bands:
        fill_band(axes, graph.curves[low], graph.curves[high], graph, window)
    for curve in graph.curves:
        draw_curve(axes, curve, graph, window)
    draw_points(axes, graph)
    room = round((inches[0] - 1) * _CHARACTERS)
    title = graph.heading or graph.title(fitted=extent.is_fitted, room=room)
    axes.set_title(title, loc="left", color=ink, fontsize=FONT)
    names = graph.axis_names
    if names is None or len(names[1]) > _NAME_MOST or (graph.has_own_colors and not graph.texts):
        axes.set_xlabel(graph.label, color=ink, fontsize=FONT)
    else:
        axes.set_xlabel(names[0], color=ink, fontsize=FONT)
        axes.set_ylabel(names[1], color=ink, fontsize=FONT)
    if extent.outside and not extent.inside and not extent.is_fitted:
        _say(axes, notice(extent, "display fit shows all"), ink)
    if graph.keys:
        _draw_keys(figure, graph, ink)
    return figure


def _say(axes: Axes, text: str, ink: Tint) -> None:
    """Write into a frame that would be empty without a word."""
    axes.text(0.5, 0.5, text, color=ink, fontsize=FONT, ha="center", transform=axes.transAxes)


def _style_axes(axes: Axes, graph: Graph, ink: Tint, reach: tuple[float, float, float, float]) -> None:
    net = None if graph.net is None else tint(graph.net, graph)
    for spine in axes.spines.values():
        spine.set_visible(net is not None)
        if net is not None:
            spine.set_color(net)
            spine.set_linewidth(_SPINE)
    axes.tick_params(colors=ink, labelsize=FONT, length=4 if net is not None else 0)
    left, right, bottom, top = reach
    for axis, low, high, is_log in (
        (axes.xaxis, left, right, graph.axes.log_x), (axes.yaxis, bottom, top, graph.axes.log_y)
    ):  # fmt: skip
        if is_log:
            ticks, labels = log_ticks(low, high)
            minor = minor_log_ticks(low, high, 100)
        else:
            ticks = round_ticks(low, high)
            labels, minor = tick_labels(ticks), minor_ticks(ticks, low, high, 40)
        axis.set_ticks(ticks, labels)
        if net is not None:
            axis.set_ticks(minor, minor=True)
    axes.set_xlim(left, right)
    axes.set_ylim(bottom, top)
    if graph.axes.equal and right > left and top > bottom:
        axes.set_box_aspect((top - bottom) / (right - left))
    if net is None:
        return
    axes.tick_params(which="minor", colors=net, length=2)
    axes.grid(visible=True, which="major", color=net, linewidth=0.6, alpha=0.15 if net == ink else 0.75)


def _draw_keys(figure: Figure, graph: Graph, ink: Tint) -> None:
    from matplotlib.legend_handler import HandlerTuple
    from matplotlib.lines import Line2D

    keys = graph.keys
    widest = max(len(key.name) for key in keys) + _KEY_CHARACTERS
    columns = max(min(len(keys), 8, int(figure.get_figwidth() * _CHARACTERS / widest)), 1)
    handles: list[Any] = [  # several lines side by side are a tuple, which its types do not know
        tuple(
            Line2D(
                [],
                [],
                color=curve_tint(color, graph),
                linewidth=2 if key.dash else 3,
                linestyle="none" if key.measured else DASHES[key.dash % len(DASHES)],
                marker=MARKERS[0] if key.measured else None,
                markersize=POINT_WIDTH,
                markeredgewidth=0,
            )
            for color in key.colors
        )
        for key in keys
    ]
    legend = figure.legend(
        handles, [key.name for key in keys], loc="outside lower center", ncols=columns,
        frameon=False, handler_map={tuple: HandlerTuple(ndivide=None, pad=0.0)},
    )  # fmt: skip
    for text in legend.get_texts():
        text.set_color(ink)
