"""Compiled functions as they are mapped, with the addresses that must be put into them."""

from __future__ import annotations

from typing import NamedTuple

PAGE = 4096


class Image(NamedTuple):
    """What is mapped: `code`, at the next page `data`; offsets count from the start of the code."""

    code: bytes
    """Functions and constants."""
    data: bytes
    """Variables."""
    functions: dict[str, int]
    """Offset of each function that others may call."""
    inside: tuple[tuple[int, int], ...]
    """(place, offset): where the address of something in the image belongs."""
    outside: tuple[tuple[int, str, int], ...]
    """(place, name, addend): where the address of a function of the process belongs."""
