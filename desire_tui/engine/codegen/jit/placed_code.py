"""Puts images of compiled functions into memory without LLVM, whose library takes 50 ms to load.

Memory is first written, then made executable, never both. Where a system allows no such change (some
hardened kernels), or the machine is another one than Linux on x86-64, `can_place` says so and LLVM's linker
does the work.
"""

from __future__ import annotations

import ctypes
import functools
import mmap
import os
import struct
import sys
from typing import TYPE_CHECKING

from desire_tui.engine.codegen.jit.image import PAGE

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.codegen.jit.image import Image

_ADDRESS = struct.Struct("<Q")
_ALL_BITS = (1 << 64) - 1
_FAILED = ctypes.c_void_p(-1).value


class NotPlacedError(MemoryError):
    """The system gives no memory for code."""


class PlacedCode:
    """See `machine_code.MachineCode`. `address_of` finds functions of the process.

    NotPlacedError; KeyError: a function is not there.
    """

    def __init__(self, image: Image, address_of: Callable[[str], int]) -> None:
        start = -(-len(image.code) // PAGE) * PAGE
        self.size = start + -(-len(image.data) // PAGE) * PAGE
        self._functions = image.functions
        content = bytearray(self.size)
        content[: len(image.code)] = image.code
        content[start : start + len(image.data)] = image.data
        found = {name: address_of(name) for name in {name for _, name, _ in image.outside}}
        self._base = base = _reserved(self.size)
        put = _ADDRESS.pack_into
        for place, offset in image.inside:
            put(content, place, base + offset)
        for place, name, addend in image.outside:
            put(content, place, (found[name] + addend) & _ALL_BITS)
        ctypes.memmove(base, bytes(content), self.size)
        if _system().mprotect(base, start, mmap.PROT_READ | mmap.PROT_EXEC):
            raise NotPlacedError

    def address(self, name: str) -> int:
        """Return a function's address."""
        return self._base + self._functions[name]

    def __del__(self) -> None:
        """Free the memory; when the process ends, threads may still be at it."""
        if not sys.is_finalizing() and hasattr(self, "_base"):
            _system().munmap(self._base, self.size)


@functools.cache
def can_place() -> bool:
    """Whether code can be put into memory without LLVM's help."""
    if sys.platform != "linux" or os.uname().machine != "x86_64" or sys.maxsize < _ALL_BITS // 2:
        return False
    try:
        base = _reserved(PAGE)
    except (NotPlacedError, OSError, AttributeError):
        return False
    allowed = not _system().mprotect(base, PAGE, mmap.PROT_READ | mmap.PROT_EXEC)
    _system().munmap(base, PAGE)
    return allowed


def _reserved(size: int) -> int:
    how = mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS
    base = _system().mmap(None, size, mmap.PROT_READ | mmap.PROT_WRITE, how, -1, 0)
    if base is None or base == _FAILED:
        raise NotPlacedError
    return int(base)


@functools.cache
def _system() -> ctypes.CDLL:
    system = ctypes.CDLL(None)
    system.mmap.restype = ctypes.c_void_p
    system.mmap.argtypes = (ctypes.c_void_p, ctypes.c_size_t, *(ctypes.c_int,) * 3, ctypes.c_long)
    system.mprotect.argtypes = (ctypes.c_void_p, ctypes.c_size_t, ctypes.c_int)
    system.munmap.argtypes = (ctypes.c_void_p, ctypes.c_size_t)
    return system
