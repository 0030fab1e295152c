"""Numbers that stand in native code's memory, seen as arrays.

A callback of a solver sees the same few vectors at each call, and making an array of one costs more than what
is computed with it: the arrays are kept. They own nothing, and are used only while their memory is there.
"""

from __future__ import annotations

import ctypes
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.engine.integration.plain_types import Reals

_KEPT_MOST = 256
"""Some twenty vectors belong to a solver."""


@lru_cache(_KEPT_MOST)
def reals(address: int, count: int) -> NDArray[np.float64]:
    """Return the `count` numbers at an address."""
    return np.ctypeslib.as_array((ctypes.c_double * count).from_address(address))


def pointed_at(place: Reals, count: int) -> NDArray[np.float64]:
    """Return the `count` numbers that a pointer points at."""
    return reals(ctypes.addressof(place.contents), count)


def address_of(array: NDArray[Any]) -> int:
    """Return where an array's numbers stand (one at least), in a fifth of the time of `array.ctypes.data`."""
    return ctypes.addressof(ctypes.c_char.from_buffer(array.data))
