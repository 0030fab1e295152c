"""Pictures of arrays (SHOW), drawn by matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.graph.model import SQUARE_MOST

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from desire_tui.engine.graph.model import ShownArray

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
