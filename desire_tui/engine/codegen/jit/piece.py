"""A function to be compiled: its text, and what that text calls."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    import ctypes


class Piece(NamedTuple):
    """An LLVM function whose name is a digest of its text.

    `needs`: declarations and helper functions that must stand in the same module; `temps`: doubles of scratch
    memory it wants at `WorkMemory.temps`.
    """

    name: str
    text: str
    needs: frozenset[str]
    temps: int = 0


class PieceCall(NamedTuple):
    """A piece and the data it is called with, if any (`pieces.rolled_pieces`)."""

    piece: Piece
    data: ctypes.Array[ctypes.c_uint64] | None = None
