"""Pictures of arrays (SHOW), drawn by matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.graph.cells import cell_ticks
from desire_tui.engine.graph.model import SQUARE_MOST

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from desire_tui.engine.graph.cells import Cells
    from desire_tui.engine.graph.model import Graph, ShownArray

    Floats = NDArray[np.float64]
    Tint = tuple[float, float, float]

FONT = 11
"""Points; of all that is written in a picture."""


def draw_arrays(shown: list[tuple[ShownArray, Floats]], places: list[Axes], ink: Tint) -> None:
    """Draw arrays (with their newest values) each in its place."""
    for (array, values), axes in zip(shown, places, strict=True):
        if array.by_size:
            _draw_squares(axes, array, values)
        else:
            axes.imshow(values, cmap="gray", vmin=-array.scale, vmax=array.scale, interpolation="nearest")
        axes.set_title(array.name, color=ink, fontsize=FONT)
        axes.set_xticks([])
        axes.set_yticks([])


def draw_cells(figure: Figure, axes: Axes, picture: Floats, graph: Graph, cells: Cells, ink: Tint) -> None:
    """Draw a picture whose sides have values, with a bar that says what its colours mean."""
    drawn = axes.imshow(
        cells.low + (cells.high - cells.low) * picture, cmap="viridis", vmin=cells.low, vmax=cells.high,
        interpolation="nearest", aspect="auto",
    )  # fmt: skip
    for axis, values, most in ((axes.xaxis, cells.columns, 10), (axes.yaxis, cells.rows, 12)):
        places, labels = zip(*cell_ticks(values, most), strict=True)
        axis.set_ticks(places, labels)
    across, down = graph.axis_names or ("", "")
    axes.set_xlabel(across, color=ink, fontsize=FONT)
    axes.set_ylabel(down, color=ink, fontsize=FONT)
    axes.set_title(graph.heading, loc="left", color=ink, fontsize=FONT)
    bar = figure.colorbar(drawn, ax=axes)
    for side in (axes, bar.ax):
        side.tick_params(colors=ink, labelsize=FONT)


def _draw_squares(axes: Axes, array: ShownArray, values: Floats) -> None:
    """Positive elements white, negative ones black, on the grey of 0."""
    from matplotlib.collections import PolyCollection

    sides = array.sides(values)
    row, column = np.nonzero(np.nan_to_num(sides))
    drawn = sides[row, column]
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) / 2
    size = SQUARE_MOST * np.abs(drawn)[:, None, None]
    squares = np.stack([column, row], axis=1)[:, None, :] + corners * size
    tints = np.where(drawn > 0, "white", "black").tolist()
    axes.add_collection(PolyCollection(list(squares), facecolors=tints, linewidths=0))
    axes.set_facecolor("gray")
    axes.set_xlim(-0.5, values.shape[1] - 0.5)
    axes.set_ylim(values.shape[0] - 0.5, -0.5)
    axes.set_aspect("equal")
