"""Marks of places as lines: they can be told apart in a terminal too, where a point is a point."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

Shape = Literal["circle", "disc", "square", "block", "cross", "diamond"]

_SIZE = (0.009, 0.014)
"""Half width and height, in parts of the graph's."""
_FILLED = (1.0, 0.75, 0.5, 0.25)
_CIRCLE: NDArray[np.complex128] = np.exp(2j * np.pi * np.arange(17) / 16)
_SQUARE: NDArray[np.complex128] = np.array([1 + 1j, -1 + 1j, -1 - 1j, 1 - 1j, 1 + 1j])
_DIAMOND: NDArray[np.complex128] = np.array([1.3, 1.3j, -1.3, -1.3j, 1.3])
_GAP = np.array([np.nan * (1 + 1j)])
_CROSS = np.concatenate([[-1 - 1j, 1 + 1j], _GAP, [-1 + 1j, 1 - 1j]])


def _outline(shape: Shape) -> NDArray[np.complex128]:
    match shape:
        case "circle":
            return _CIRCLE
        case "square":
            return _SQUARE
        case "diamond":
            return _DIAMOND
        case "cross":
            return _CROSS
        case "disc" | "block":
            of = _CIRCLE if shape == "disc" else _SQUARE
            return np.concatenate([part * of for part in _FILLED])


def marks(shape: Shape, places: Floats) -> Floats:
    """Return marks at places, 2 by count in parts of the graph, as lines parted by nan, 2 by points."""
    outline = np.concatenate([_outline(shape), _GAP])
    forms = np.stack([_SIZE[0] * outline.real, _SIZE[1] * outline.imag])
    return np.asarray(places[:, :, None] + forms[:, None, :]).reshape(2, -1)
