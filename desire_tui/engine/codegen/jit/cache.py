"""Keeps compiled code by its text: what was compiled once is not compiled again."""

from __future__ import annotations

import threading
from collections import OrderedDict
from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.codegen.jit.compiler import compile_text, kept_code, module_text, name_on_disk

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from desire_tui.engine.codegen.jit.machine_code import MachineCode
    from desire_tui.engine.codegen.jit.piece import Piece

_BYTES_MOST = 12_000_000
"""Of code that may be in nobody's use: a model of 1,400 equations takes 2 MB."""
_TEXT_MOST = 400_000
"""Characters that LLVM is given at once: nothing can break it off, and what waits is let in between."""


class Compiled(NamedTuple):
    """A function's address, and the code that holds it: keep both."""

    address: int
    code: MachineCode
    size: int
    """Its share of the code's bytes."""


Files = tuple[tuple[str, tuple[str, ...]], ...]
"""Names of code on disk, with the functions that each holds."""


class CodeCache:
    """Functions by name (which is a digest of the text) and quality; `keep`: on disk too."""

    def __init__(self, *, keep: bool = False) -> None:
        self._keep_on_disk = keep
        self._known: OrderedDict[tuple[str, bool], Compiled] = OrderedDict()
        self._lock = threading.Lock()
        self._bytes = 0

    @property
    def bytes(self) -> int:
        """How much is kept, about."""
        return self._bytes

    def find(self, name: str, *, fast: bool) -> Compiled | None:
        """Return what is there already."""
        with self._lock:
            found = self._known.get((name, fast))
            if found is not None:
                self._known.move_to_end((name, fast))
            return found

    def quick(self, pieces: Iterable[Piece]) -> dict[str, Compiled]:
        """Return all pieces compiled, the best code that is there; what is missing is compiled at level 0."""
        found: dict[str, Compiled] = {}
        missing: dict[str, Piece] = {}
        for piece in pieces:
            known = self.find(piece.name, fast=True) or self.find(piece.name, fast=False)
            if known is not None:
                found[piece.name] = known
            else:
                missing[piece.name] = piece
        for together in _modules(missing.values()):
            code = compile_text(_module(together), level=0, keep=self._keep_on_disk)
            share = code.size // len(together)
            for piece in together:
                compiled = Compiled(code.address(piece.name), code, share)
                found[piece.name] = self._keep(piece.name, compiled, fast=False)
        return found

    def fast(self, piece: Piece, *, slp: bool = True, passes: bool = True) -> Compiled:
        """Return a piece compiled as well as LLVM can; `slp`: several neighbours at a time.

        Without `passes`: they find nothing in straight-line code whose values are named once.
        """
        known = self.find(piece.name, fast=True)
        if known is not None:
            return known
        code = compile_text(_module([piece]), level=2, slp=slp, passes=passes, keep=self._keep_on_disk)
        return self._keep(piece.name, Compiled(code.address(piece.name), code, code.size), fast=True)

    def files(self, pieces: Sequence[Piece]) -> tuple[Files, Files] | None:
        """Return where later processes find what `quick` and `fast` make of pieces; None: not all of it."""
        if not self._keep_on_disk:
            return None
        groups = ((list(_modules(pieces)), 0), ([[piece] for piece in pieces], 2))
        quick, fast = (
            [
                (name_on_disk(_module(group), level=level, slp=level > 0), tuple(p.name for p in group))
                for group in made
            ]
            for made, level in groups
        )
        found = [tuple((name, held) for name, held in some if name is not None) for some in (quick, fast)]
        return (found[0], found[1]) if [*map(len, found)] == [len(quick), len(fast)] else None

    def load(self, files: Files, *, fast: bool) -> dict[str, Compiled] | None:
        """Return functions by their files' names (`files`), without their texts; None: some are not there."""
        found: dict[str, Compiled] = {}
        for file, names in files:
            known = {name: self.find(name, fast=True) or self.find(name, fast=fast) for name in names}
            if None in known.values():
                code = kept_code(file)
                if code is None:
                    return None
                share = code.size // len(names)
                try:
                    known = {name: Compiled(code.address(name), code, share) for name in names}
                except KeyError:
                    return None
                for name, compiled in known.items():
                    assert compiled is not None
                    self._keep(name, compiled, fast=fast)
            found |= {name: compiled for name, compiled in known.items() if compiled is not None}
        return found

    def _keep(self, name: str, compiled: Compiled, *, fast: bool) -> Compiled:
        with self._lock:
            before = self._known.pop((name, fast), None)
            self._known[name, fast] = compiled
            self._bytes += compiled.size - (before.size if before is not None else 0)
            while self._bytes > _BYTES_MOST and len(self._known) > 1:
                self._bytes -= self._known.popitem(last=False)[1].size
        return compiled


def _modules(pieces: Iterable[Piece]) -> Iterator[list[Piece]]:
    together: list[Piece] = []
    length = 0
    for piece in pieces:
        if together and length + len(piece.text) > _TEXT_MOST:
            yield together
            together, length = [], 0
        together.append(piece)
        length += len(piece.text)
    if together:
        yield together


def _module(pieces: list[Piece]) -> str:
    needs: set[str] = set()
    for piece in pieces:
        needs |= piece.needs
    return module_text([piece.text for piece in pieces], needs)
