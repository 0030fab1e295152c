"""Files that only save time: read if they are whole, written if that is possible, never required."""

# ruff: noqa: PTH108, PTH118, PTH120, PTH123 - pathlib would add 5 ms to every start

from __future__ import annotations

import os
from contextlib import suppress
from time import time
from zlib import crc32

from desire_tui.engine import user_folders

_NOTED_EVERY_SECONDS = 86_400.0


def read(name: str, *, is_used: bool = False) -> bytes | None:
    """Return a file's content; None if it is absent, unreadable or damaged.

    `is_used`: note that somebody wanted it, for `trim`.
    """
    try:
        with open(_path(name), "rb") as file:
            check, content = file.read(4), file.read()
            if is_used and time() - os.fstat(file.fileno()).st_mtime > _NOTED_EVERY_SECONDS:
                with suppress(OSError):
                    os.utime(file.fileno())
    except OSError:
        return None
    return content if check == _check(content) else None


def write(name: str, content: bytes) -> None:
    """Store a file if the folder can be written.

    Not forced to the disk: that takes time, and `read` finds out what a power failure damaged.
    """
    with suppress(OSError):
        user_folders.write_private(_path(name), _check(content) + content, sync=False)


def trim(prefix: str, most: int) -> None:
    """Remove those files with a prefix that nobody wanted for longest, until the others have `most` bytes."""
    with suppress(OSError), os.scandir(os.path.dirname(_path(prefix))) as entries:
        known = [(entry.stat(), entry.path) for entry in entries if entry.name.startswith(prefix)]
        known.sort(key=lambda file: file[0].st_mtime_ns, reverse=True)
        total = 0
        for status, path in known:
            total += status.st_size
            if total > most:
                with suppress(OSError):
                    os.unlink(path)


def holds_only_ours() -> bool:
    """Whether nobody else can put files there: what is read may be run."""
    return user_folders.is_ours_alone(user_folders.folder("cache"))


def _path(name: str) -> str:
    return os.path.join(user_folders.folder("cache"), name)


def _check(content: bytes) -> bytes:
    return crc32(content).to_bytes(4, "big")
