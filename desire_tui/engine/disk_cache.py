"""Files that only save time: read if they are whole, written if that is possible, never required."""

# ruff: noqa: PTH118, PTH123 - pathlib would add 5 ms to every start

from __future__ import annotations

import os
from contextlib import suppress
from zlib import crc32

from desire_tui.engine import user_folders


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
    with suppress(OSError):
        user_folders.write_private(_path(name), _check(content) + content, sync=False)


def holds_only_ours() -> bool:
    """Whether nobody else can put files there: what is read may be run."""
    return user_folders.is_ours_alone(user_folders.folder("cache"))


def _path(name: str) -> str:
    return os.path.join(user_folders.folder("cache"), name)


def _check(content: bytes) -> bytes:
    return crc32(content).to_bytes(4, "big")
