"""A function to be compiled: its text, and what that text calls."""

from __future__ import annotations

from typing import NamedTuple


class Piece(NamedTuple):
    """An LLVM function whose name is a digest of its text.

    `needs`: declarations and helper functions that must stand in the same module; `temps`: doubles of scratch
    memory it wants at `WorkMemory.temps`.
    """

    name: str
    text: str
    needs: frozenset[str]
    temps: int = 0
