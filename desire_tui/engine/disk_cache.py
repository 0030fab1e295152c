"""Files that only save time: read if they are whole, written if that is possible, never required."""

# ruff: noqa: PTH111, PTH118, PTH123 - pathlib would add 5 ms to every start

from __future__ import annotations

import os
import sys
from contextlib import suppress
from zlib import crc32

from desire_tui.engine.atomic_file import replacing


def read(name: str) -> bytes | None:
    """Return a file's content; None if it is absent, unreadable or damaged."""
    try:
        with open(_path(name), "rb") as file:
            check, content = file.read(4), file.read()
    except OSError:
        return None
    return content if check == _check(content) else None


def write(name: str, content: bytes) -> None:
    """Store a file if the folder can be written.

    Not forced to the disk: that takes time, and `read` finds out what a power failure damaged.
    """
    with suppress(OSError), replacing(_path(name), "wb", make_folder=True, sync=False) as file:
        file.write(_check(content) + content)


def _path(name: str) -> str:
    if sys.platform == "linux":  # the same folder as platformdirs names, without its 5 ms
        folder = os.path.join(
            os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache"), "desire-tui"
        )
    else:
        from platformdirs import user_cache_dir

        folder = user_cache_dir("desire-tui")
    return os.path.join(folder, name)


def _check(content: bytes) -> bytes:
    return crc32(content).to_bytes(4, "big")
