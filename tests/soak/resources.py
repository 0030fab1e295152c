"""What a process holds: memory, threads, open files, handlers at exit, temporary files."""

from __future__ import annotations

import atexit
import ctypes
import gc
import os
import tempfile
import threading
from pathlib import Path
from typing import NamedTuple

_PAGE = os.sysconf("SC_PAGE_SIZE")


class Resources(NamedTuple):
    """One look at the process."""

    memory: float
    """Resident, in MB."""
    threads: int
    open_files: int
    exit_handlers: int
    temporary_files: int


def resources() -> Resources:
    """Count what the process holds now, once all that can be freed is."""
    gc.collect()
    _return_free_memory()
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return Resources(
        memory=pages * _PAGE / 1e6,
        threads=threading.active_count(),
        open_files=len(list(Path("/proc/self/fd").iterdir())),
        exit_handlers=atexit._ncallbacks(),  # the only way to count them
        temporary_files=sum(len(files) for _, _, files in os.walk(tempfile.gettempdir())),
    )


def most(one: Resources, other: Resources) -> Resources:
    """Return the larger count of each kind."""
    return Resources(*map(max, one, other))


def _return_free_memory() -> None:
    """Let the C library give back what it holds free: else freed memory counts as held."""
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
    if trim is not None:
        trim(0)
