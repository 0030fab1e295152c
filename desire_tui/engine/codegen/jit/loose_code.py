"""Code whose arithmetic the optimiser may rearrange: what `fast` in a segment asks for (docs/performance.md).

Products and sums may become fused multiply-adds, sums may be added in another order, quotients may become
products: the last digits of results then differ between machines, and between quick and improved code.
Infinities and what is not a number are still found.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir.shared_loops import PREFIX
from desire_tui.engine.codegen.jit.cache import CodeCache
from desire_tui.engine.codegen.jit.piece import Piece

if TYPE_CHECKING:
    from collections.abc import Iterable

    from desire_tui.engine.codegen.jit.cache import Compiled

_ARITHMETIC = re.compile(r"= (fadd|fsub|fmul|fdiv|fneg) (?=double|<)")
_BLOCK = f"define internal void @{PREFIX}"
_FLAGS = r"= \1 contract reassoc nsz arcp "


class LooseCode(CodeCache):
    """Compiles pieces loosely, and keeps them beside the strict ones, under names of their own."""

    def __init__(self, strict: CodeCache) -> None:
        super().__init__()
        self._strict = strict

    @property
    def bytes(self) -> int:
        """How much both keep, about."""
        return self._strict.bytes

    def find(self, name: str, *, fast: bool) -> Compiled | None:
        """Return what is there already, by the strict piece's name."""
        return self._strict.find(_loose(name), fast=fast)

    def quick(self, pieces: Iterable[Piece]) -> dict[str, Compiled]:
        """See `CodeCache.quick`; by the strict pieces' names."""
        every = list(pieces)
        found = self._strict.quick([loosened(piece) for piece in every])
        return {piece.name: found[_loose(piece.name)] for piece in every}

    def fast(self, piece: Piece, *, slp: bool = True, passes: bool = True) -> Compiled:
        """See `CodeCache.fast`."""
        return self._strict.fast(loosened(piece), slp=slp, passes=passes)


def loosened(piece: Piece) -> Piece:
    """Return a piece whose own arithmetic may be rearranged, that of its blocks too.

    Other helpers stay as they are.
    """
    text = _ARITHMETIC.sub(_FLAGS, piece.text).replace(f"@{piece.name}(", f"@{_loose(piece.name)}(")
    needs = {_ARITHMETIC.sub(_FLAGS, need) if need.startswith(_BLOCK) else need for need in piece.needs}
    return Piece(_loose(piece.name), text, frozenset(needs), piece.temps)


def _loose(name: str) -> str:
    return f"{name}.loose"
