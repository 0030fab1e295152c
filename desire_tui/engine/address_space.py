"""A piece of memory whose address never changes: reserved once, its pages touched only as they are used."""

from __future__ import annotations

import gc
import mmap
import os
import resource
from pathlib import Path

import numpy as np

ROOM_PARTS = 8
"""Where address space is limited, each piece takes such a part of what is left: there will be others."""
_DROP_LEAST = 1 << 20
"""Bytes of whole pages that are rather given back than written."""
_DROPPED_PAGES_ARE_ZERO = os.uname().sysname == "Linux"  # elsewhere MADV_DONTNEED is only a hint
_NO_RESERVE = 0x4000 if os.uname().sysname == "Linux" else 0  # MAP_NORESERVE, not named before 3.13


class AddressSpace:
    """So many bytes of 0 (None: as many as a program may take), or fewer where there are not so many."""

    def __init__(self, size: int | None = None) -> None:
        """OSError: there are not even 16 MB."""
        self._memory = _reserved(_allowed() if size is None else size)
        self.view = memoryview(self._memory)
        """All of it."""
        self._bytes = np.frombuffer(self.view, dtype=np.uint8)

    def zero(self, start: int, count: int) -> None:
        """Fill some bytes with 0; whole pages of a large piece are given back to the system, not written."""
        end = start + count
        first, last = _pages(start), end // mmap.PAGESIZE * mmap.PAGESIZE
        if _DROPPED_PAGES_ARE_ZERO and last - first >= _DROP_LEAST:
            self._memory.madvise(mmap.MADV_DONTNEED, first, last - first)
            self._bytes[start:first] = 0
            self._bytes[last:end] = 0
        else:
            self._bytes[start:end] = 0


def _pages(size: int) -> int:
    return -(-size // mmap.PAGESIZE) * mmap.PAGESIZE


def _allowed() -> int:
    """Three quarters of the memory of the machine or container this runs in; less under `ulimit -v`."""
    size = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    for limit in ("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"):
        try:
            size = min(size, int(Path(limit).read_text(encoding="ascii")))
        except (OSError, ValueError):
            continue
    address_space, _ = resource.getrlimit(resource.RLIMIT_AS)
    if address_space != resource.RLIM_INFINITY:  # `ulimit -v`
        if _free(address_space) < address_space // 2:
            gc.collect()  # sessions that nobody has any more
        size = min(size, _free(address_space) // ROOM_PARTS)
    return max(size // 4 * 3, 1 << 27)


def _free(address_space: int) -> int:
    """Return how much of a limited address space is left."""
    try:
        used = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0]) * mmap.PAGESIZE
    except OSError:
        used = 0
    return max(address_space - used, 0)


def _reserved(allowed: int) -> mmap.mmap:
    """Reserve so many bytes, or as many as there are."""
    size = _pages(allowed)
    while True:
        try:
            return mmap.mmap(-1, size, flags=mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS | _NO_RESERVE)
        except OSError:
            if size < 1 << 24:
                raise
            size = _pages(size // 2)
