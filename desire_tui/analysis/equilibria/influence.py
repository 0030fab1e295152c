"""Whether a parameter matters for a flow."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.analysis.equilibria.flow import around

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from desire_tui.analysis.equilibria.flow import Flow

    Floats = NDArray[np.float64]

_PLACES = 8
USEFUL = "a parameter that stands in a d/dt line, or in what one depends on"
"""What to do about one without influence."""


def has_influence(flow: Flow, size: Floats, name: str, values: Iterable[float]) -> bool:
    """Whether derivatives at some places about as far from 0 as `size` differ with a parameter."""
    places = around(size, np.random.default_rng(3), _PLACES)
    first, *others = (flow.rate(places, {name: value}) for value in values)
    return not all(np.array_equal(first, other, equal_nan=True) for other in others)
