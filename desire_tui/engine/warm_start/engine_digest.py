"""A name for the engine as it is now: what another one stored may mean something else."""

# ruff: noqa: PTH118, PTH120 - pathlib would take longer than all the rest

from __future__ import annotations

import functools
import os
import sys

from desire_tui import engine
from desire_tui.engine.digest import blake2b
from desire_tui.version import __version__

_ROOMS = "check codegen integration lowered lowering nodes passes structure syntax warm_start".split()  # noqa: SIM905 - words
"""Rooms of the engine that decide what is stored, besides its own files."""


@functools.cache
def engine_digest() -> bytes | None:
    """Return a digest of the engine's version and files; None: they changed while this process ran."""
    top = os.path.dirname(engine.__file__)
    found: list[tuple[str, int, int]] = []
    _add(top, found, inner=False)
    for room in _ROOMS:
        _add(os.path.join(top, room), found, inner=True)
    if max(changed for _, _, changed in found) > engine.IMPORTED_AT:
        return None
    found.sort()
    return blake2b(repr((__version__, sys.version, found)).encode(), digest_size=16).digest()


def _add(folder: str, found: list[tuple[str, int, int]], *, inner: bool) -> None:
    """Add path, size and time of the last change of a folder's files; `inner`: of its folders' files too."""
    with os.scandir(folder) as entries:
        for entry in entries:
            name = entry.name
            if name.endswith((".py", ".lark")):
                status = entry.stat()
                found.append((entry.path, status.st_size, status.st_ctime_ns))
            elif inner and "." not in name and name != "__pycache__":
                _add(entry.path, found, inner=True)
