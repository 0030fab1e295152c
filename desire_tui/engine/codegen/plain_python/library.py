"""Functions of plain Python beyond Python's own; each computes the same when Python runs it."""

from __future__ import annotations

from typing import Any


def copy(to: Any, to_first: int, source: Any, source_first: int, count: int) -> None:
    """Copy elements between arrays of one type; compiled as one `memmove`."""
    for i in range(count):
        to[to_first + i] = source[source_first + i]
