"""The frame around a text graph — axes, ticks, labels — drawn by plotext.

plotext 6 aborts the whole process on nan, inf and very large values, so it is never given a curve: it draws
an empty frame, and the braille canvas is put into it. A frame takes some milliseconds; keep it until size or
limits change.
"""

from __future__ import annotations

import re
from functools import lru_cache
from threading import Lock
from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import dataclass, replace
from desire_tui.engine.graph.axes import equalized
from desire_tui.engine.graph.cells import cell_ticks
from desire_tui.engine.graph.fit import WHOLE, limits
from desire_tui.engine.graph.ticks import log_ticks, minor_log_ticks, minor_ticks, round_ticks, tick_labels
from desire_tui.engine.visible_text import visible_line

if TYPE_CHECKING:
    from desire_tui.engine.graph.cells import Cells
    from desire_tui.engine.graph.model import Graph

    Window = tuple[float, float, float, float]
    Ticks = tuple[tuple[float, str], ...]

COLUMNS_LEAST, ROWS_LEAST = 20, 6
_LABEL_GAP = 2
_NO_TICKS: Ticks = ()
_MINOR_COLUMNS = 6
_MINOR = {"─": "┴", "│": "├"}
_ESCAPES = re.compile(r"\x1b\[[0-9;]*m")
_plotext_lock = Lock()  # plotext has one global figure, and two threads may draw at once


@dataclass(frozen=True, slots=True)
class TextFrame:
    """Lines of plain text around a hole of `columns` × `rows` cells that begins at `left`, `top`."""

    lines: tuple[str, ...]
    left: int
    top: int
    columns: int
    rows: int
    has_net: bool = True


def text_frame(
    graph: Graph,
    columns: int,
    rows: int,
    window: Window = WHOLE,
    *,
    fitted: bool = False,
    reserved: int = 0,
) -> TextFrame:
    """Return the frame of a graph in `columns` × `rows` cells, labelled for a window in frame units.

    `fitted`: the window is the one that holds all curves. `reserved` columns of the title row stay free.
    """
    columns, rows = max(columns, COLUMNS_LEAST), max(rows, ROWS_LEAST)
    title = graph.title(fitted=fitted, room=columns - 2 * reserved)
    if graph.frame.kind == "picture":
        sides = (_NO_TICKS, _NO_TICKS) if graph.cells is None else _sides(graph.cells, columns, rows)
        return _frame(columns, rows, title, graph.label, *sides, graph.net is not None)
    left, right, bottom, top = limits(graph, window)
    axes = graph.axes
    y_axis = _ticks(bottom, top, max(min((rows - 4) // 2, 7), 2), is_log=axes.log_y)
    inside = columns - max((len(label) for _, label in y_axis), default=0) - 2
    x_axis = _x_ticks(left, right, inside, is_log=axes.log_x)
    minor = (
        _minor(x_axis, left, right, inside // _MINOR_COLUMNS, is_log=axes.log_x),
        _minor(y_axis, bottom, top, (rows - 4) // 2, is_log=axes.log_y),
    )
    return _frame(columns, rows, title, graph.label, x_axis, y_axis, graph.net is not None, minor)


def equal_view(graph: Graph, columns: int, rows: int, window: Window, *, reserved: int = 0) -> Window:
    """Return the window as it is drawn in so many cells: larger, where both axes are to have equal scales."""
    if not graph.axes.equal or graph.frame.kind == "picture":
        return window
    frame = text_frame(graph, columns, rows, window, reserved=reserved)
    ratio = frame.columns / (2 * frame.rows)  # a cell is twice as high as wide
    return equalized(graph.axes.frame(graph.frame), window, ratio)


def _minor(ticks: Ticks, low: float, high: float, most: int, *, is_log: bool) -> tuple[float, ...]:
    """Return where minor ticks stand, in parts of the way from low to high."""
    if is_log:
        places = minor_log_ticks(low, high, most)
    else:
        places = minor_ticks(tuple(low + part * (high - low) for part, _ in ticks), low, high, most)
    return tuple((place - low) / ((high - low) or 1.0) for place in places)


def _sides(cells: Cells, columns: int, rows: int) -> tuple[Ticks, Ticks]:
    """Return labels at the middles of a picture's columns and rows, as many as have room."""
    widest = max(len(label) for _, label in cell_ticks(cells.columns, len(cells.columns)))
    most = (columns * 3 // 4) // (widest + _LABEL_GAP)
    wide, high = len(cells.columns), len(cells.rows)
    across = tuple(((place + 0.5) / wide, label) for place, label in cell_ticks(cells.columns, most))
    down = cell_ticks(cells.rows, max((rows - 4) // 2, 1))
    return across, tuple((1 - (place + 0.5) / high, label) for place, label in reversed(down))


def _x_ticks(low: float, high: float, columns: int, *, is_log: bool) -> Ticks:
    """Return as many ticks as have room with their labels."""
    for most in range(7, 1, -1):
        ticks = _ticks(low, high, most, is_log=is_log)
        widest = max((len(label) for _, label in ticks), default=0)
        if (len(ticks) - 1) * (widest + _LABEL_GAP) <= columns - widest:
            return ticks
    return ticks


def _ticks(low: float, high: float, most: int, *, is_log: bool) -> Ticks:
    """Return ticks as parts of the way from low to high, with their labels; the limits if none is round."""
    values, labels = log_ticks(low, high, most) if is_log else ((), ())
    if not values:
        values = round_ticks(low, high, most) or (low, high)
        labels = tick_labels(values)
    places = ((value - low) / ((high - low) or 1.0) for value in values)
    return tuple(zip(places, labels, strict=True))


@lru_cache(maxsize=16)
def _frame(
    columns: int,
    rows: int,
    title: str,
    caption: str,
    x_ticks: Ticks,
    y_ticks: Ticks,
    net: bool,
    minor: tuple[tuple[float, ...], tuple[float, ...]] = ((), ()),
) -> TextFrame:
    import plotext

    with _plotext_lock:
        plotext.terminal.limit(
            width=False, height=False
        )  # the pane's size counts, not that of plotext's terminal
        figure = plotext.figure
        figure.clear()
        figure.theme("colorless")
        figure.plot_size(columns, rows)
        figure.title(visible_line(title[:columns]))
        # The positions of ticks in parts of each side are all that plotext needs to know
        figure.ruler("x").lim(0.0, 1.0)
        figure.ruler("y").lim(0.0, 1.0)
        for side, ticks in (("x", x_ticks), ("y", y_ticks)):
            figure.ruler(side).ticks([place for place, _ in ticks], [label for _, label in ticks])
        figure.axes(net)
        if caption:
            figure.label(visible_line(caption[:columns]), "x")
        text = _ESCAPES.sub("", figure.build().string())
    lines = tuple(line.ljust(columns)[:columns] for line in text.split("\n")[:rows])
    top = next((i for i, line in enumerate(lines) if "┌" in line), None)
    bottom = next((i for i, line in enumerate(lines) if "└" in line), None)
    if top is None or bottom is None:  # no net: the space between title and labels
        left = max((len(label) for _, label in y_ticks), default=0)
        return TextFrame(lines, left, 1, columns - left, rows - 2 - bool(caption), has_net=False)
    left = lines[top].index("┌") + 1
    frame = TextFrame(lines, left, top + 1, lines[top].index("┐") - left, bottom - top - 1)
    return replace(frame, lines=_with_minor(frame, *minor))


def _with_minor(frame: TextFrame, x: tuple[float, ...], y: tuple[float, ...]) -> tuple[str, ...]:
    """Return the frame's lines with minor ticks, which point to the inside."""
    lines = [list(line) for line in frame.lines]
    places = [(frame.top + frame.rows, frame.left + round(part * (frame.columns - 1))) for part in x]
    places += [(frame.top + round((1 - part) * (frame.rows - 1)), frame.left - 1) for part in y]
    for row, column in places:
        lines[row][column] = _MINOR.get(lines[row][column], lines[row][column])
    return tuple("".join(line) for line in lines)
