"""The frame around a text graph — axes, ticks, labels — drawn by plotext.

plotext 6 aborts the whole process on nan, inf and very large values, so it is never given a curve: it draws
an empty frame, and the braille canvas is put into it. A frame takes some milliseconds; keep it until size or
limits change.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import lru_cache
from threading import Lock
from typing import TYPE_CHECKING

from desire_tui.engine.visible_text import visible_line

if TYPE_CHECKING:
    from desire_tui.engine.graph.model import Graph

    Window = tuple[float, float, float, float]

COLUMNS_LEAST, ROWS_LEAST = 20, 6
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


def text_frame(graph: Graph, columns: int, rows: int, window: Window = (0.0, 1.0, 0.0, 1.0)) -> TextFrame:
    """Return the frame of a graph in `columns` × `rows` cells, labelled for a window in frame units.

    The whole frame is labelled at start, middle and end (language.md 13); a zoomed one too, with its own
    values.
    """
    columns, rows = max(columns, COLUMNS_LEAST), max(rows, ROWS_LEAST)
    if graph.frame.kind == "picture":
        return _frame(columns, rows, graph.title, graph.caption, (), (), graph.net is not None)
    left, right, bottom, top = limits(graph, window)
    x_ticks = tuple(tick_label(v) for v in (left, (left + right) / 2, right))
    y_ticks = tuple(tick_label(v) for v in (bottom, (bottom + top) / 2, top))
    return _frame(columns, rows, graph.title, graph.caption, x_ticks, y_ticks, graph.net is not None)


def limits(graph: Graph, window: Window) -> Window:
    """Return left, right, bottom, top of a window (frame units) in program units."""
    frame = graph.frame
    width, height = frame.right - frame.left, frame.top - frame.bottom
    left, right, bottom, top = window
    return (
        frame.left + left * width, frame.left + right * width,
        frame.bottom + bottom * height, frame.bottom + top * height,
    )  # fmt: skip


def tick_label(value: float) -> str:
    """Return a short number: at most five significant digits."""
    mantissa, e, exponent = f"{value + 0.0:.5g}".partition("e")
    return f"{mantissa}e{int(exponent)}" if e else mantissa


@lru_cache(maxsize=16)
def _frame(
    columns: int,
    rows: int,
    title: str,
    caption: str,
    x_ticks: tuple[str, ...],
    y_ticks: tuple[str, ...],
    net: bool,
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
        # The positions of ticks are all that plotext needs to know: 0, 1/2 and 1 of each side
        figure.ruler("x").lim(0.0, 1.0)
        figure.ruler("y").lim(0.0, 1.0)
        figure.ruler("x").ticks([0.0, 0.5, 1.0][: len(x_ticks)], list(x_ticks))
        figure.ruler("y").ticks([0.0, 0.5, 1.0][: len(y_ticks)], list(y_ticks))
        figure.axes(net)
        if caption:
            figure.label(visible_line(caption[:columns]), "x")
        text = _ESCAPES.sub("", figure.build().string())
    lines = tuple(line.ljust(columns)[:columns] for line in text.split("\n")[:rows])
    top = next((i for i, line in enumerate(lines) if "┌" in line), None)
    bottom = next((i for i, line in enumerate(lines) if "└" in line), None)
    if top is None or bottom is None:  # no net: the space between title and labels
        left = max((len(label) for label in y_ticks), default=0)
        return TextFrame(lines, left, 1, columns - left, rows - 2 - bool(caption))
    left = lines[top].index("┌") + 1
    return TextFrame(lines, left, top + 1, lines[top].index("┐") - left, bottom - top - 1)
