"""LLVM's linker: puts object code into memory where `placed_code` cannot, and takes it out again.

All code of a linker shares one engine of LLVM's, which costs 0.8 MB; a piece by itself takes some 40 KB. What
LLVM keeps of a piece that was taken out goes with its linker: it takes so many pieces, then the next begins.
"""

from __future__ import annotations

import sys
from functools import partial
from itertools import count
from typing import TYPE_CHECKING, Any

from desire_tui.engine.codegen.jit.llvm_turn import clear_later

if TYPE_CHECKING:
    from collections.abc import Iterable

_PIECES_MOST = 200
_OUTSIDE = "outside"
_OVERHEAD = 40_000
_linkers: set[Linker] = set()
"""Those with code in use, and the present one: LLVM wants the engine to live longer than its code."""


class LinkedCode:
    """See `machine_code.MachineCode`."""

    def __init__(self, linker: Linker, number: int, size: int) -> None:
        self._linker = linker
        self._number = number
        self.size = size
        """In bytes, about."""

    def address(self, name: str) -> int:
        """Return a function's address."""
        return self._linker.address(self._number, name)

    def __del__(self) -> None:
        """Free the memory."""
        if not sys.is_finalizing():
            clear_later(partial(self._linker.drop, self._number))


class Linker:
    """One engine of LLVM's. `symbols` are the functions of this process that code may call, by name."""

    def __init__(self, llvm: Any, target_machine: Any, symbols: dict[str, int]) -> None:
        self._llvm = llvm
        self._engine = llvm.create_lljit_compiler(target_machine)
        self._numbers = count()
        self._living: dict[int, Any] = {}  # here, or a garbage collection would free them in its own way
        self.is_full = False
        outside = llvm.JITLibraryBuilder().add_current_process()
        for name, address in symbols.items():
            outside.import_symbol(name, address).export_symbol(name)
        self._outside = outside.link(self._engine, _OUTSIDE)
        _linkers.add(self)

    def link(self, content: bytes, exported: Iterable[str]) -> LinkedCode:
        """Return the functions of an object file; those named in `exported` have addresses."""
        number = next(self._numbers)
        builder = self._llvm.JITLibraryBuilder().add_object_img(content).add_jit_library(_OUTSIDE)
        for name in exported:
            builder.export_symbol(name)
        self._living[number] = builder.link(self._engine, f"code{number}")
        code = LinkedCode(self, number, len(content) + _OVERHEAD)
        if number >= _PIECES_MOST:
            self.close()
        return code

    def address(self, number: int, name: str) -> int:
        """Return the address of a function of some code."""
        return int(self._living[number][name])

    def close(self) -> None:
        """Take no more code."""
        self.is_full = True
        self._drop_if_empty()

    def drop(self, number: int) -> None:
        """Free some code."""
        self._living.pop(number).close()
        self._drop_if_empty()

    def _drop_if_empty(self) -> None:
        if self.is_full and not self._living:
            _linkers.discard(self)
