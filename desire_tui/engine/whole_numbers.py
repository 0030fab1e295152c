"""A program's number on its way to where a whole one is needed: a count, an index, an integer of native code.

Conversion wraps or crashes there for what does not fit, so it is made here, with a range that fits.
"""

from __future__ import annotations

from math import isfinite

WHOLE_MOST = 2**53
"""Up to here doubles hold every whole number."""


def whole(value: float, least: int = -WHOLE_MOST, most: int = WHOLE_MOST) -> int | None:
    """Return a number truncated; None where it is nan, infinite or outside `least` … `most`."""
    if not isfinite(value):
        return None
    truncated = int(value)
    return truncated if least <= truncated <= most else None
