"""Files that only save time: read when they are whole, written when they can be, missed by nobody."""

# ruff: noqa: PTH103, PTH105, PTH111, PTH118, PTH120, PTH123 - pathlib would add 5 ms to every start

from __future__ import annotations

import os
import sys
from zlib import crc32


def read(name: str) -> bytes | None:
    """Return a file's content; None if it is absent, unreadable or damaged."""
    try:
        with open(_path(name), "rb") as file:
            check, content = file.read(4), file.read()
    except OSError:
        return None
    return content if check == _check(content) else None


def write(name: str, content: bytes) -> None:
    """Store a file if the folder can be written; a half-written file never gets the final name."""
    path = _path(name)
    temporary = f"{path}.{os.getpid()}"
    try:
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(temporary, "wb") as file:
            file.write(_check(content) + content)
        os.replace(temporary, path)
    except OSError:
        return


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
