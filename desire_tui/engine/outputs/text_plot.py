"""A graph as text, for terminals and files: frame, braille canvas, colour keys."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.graph.colors import curve_rgb
from desire_tui.engine.graph.fit import WHOLE, Extent, notice
from desire_tui.engine.outputs.braille_canvas import NO_COLOR, Canvas
from desire_tui.engine.outputs.incremental_drawing import Painter
from desire_tui.engine.outputs.text_frame import equal_view, text_frame

if TYPE_CHECKING:
    from desire_tui.engine.graph.color_keys import Key
    from desire_tui.engine.graph.model import Graph

REMEDY = "display fit shows all"
"""What is said to curves outside the scale where no key helps."""
_RESET = "\x1b[0m"


def text_plot(graph: Graph, columns: int, rows: int, *, colored: bool) -> str:
    """Return a graph as `rows` lines of `columns` cells, the last for keys; ANSI colours if `colored`."""
    extent = Extent(graph)
    extent.update()
    window = equal_view(graph, columns, rows - 1, extent.view() if extent.is_fitted else WHOLE)
    frame = text_frame(graph, columns, rows - 1, window, fitted=extent.is_fitted)
    canvas = Canvas(frame.columns, frame.rows)
    painter = Painter(canvas, graph, window)
    while painter.update():
        pass
    lines = []
    text = "" if extent.is_fitted else notice(extent, REMEDY)
    for number, line in enumerate(painter.clipped.lines(frame, text)):
        row = number - frame.top
        if 0 <= row < frame.rows:
            inside = "".join(_paint(text, color, graph, colored=colored) for text, color in canvas.runs(row))
            lines.append(line[: frame.left] + inside + line[frame.left + frame.columns :])
        else:
            lines.append(line.rstrip())
    keys = "   ".join(_key(key, graph, colored=colored) for key in graph.keys)
    return "\n".join([*lines, " " * frame.left + keys]).rstrip() + "\n"


def _key(key: Key, graph: Graph, *, colored: bool) -> str:
    if not colored:
        return f"{key.sign} {key.name}" if key.measured else key.name
    squares = (_paint(key.sign, color, graph, colored=True) for color in key.colors)
    return f"{''.join(squares)} {key.name}"


def _paint(text: str, color: int, graph: Graph, *, colored: bool) -> str:
    ground = "\x1b[48;2;255;255;255m" if graph.white else ""
    if not colored or not (ground or text.strip()):
        return text
    red, green, blue = curve_rgb(0 if color == NO_COLOR else color, white=graph.white)
    return f"{ground}\x1b[38;2;{red};{green};{blue}m{text}{_RESET}"
