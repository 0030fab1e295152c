"""Compiled code on disk, by name: later processes neither compile it nor load LLVM.

The folder keeps what was used lately, within bounds. What cannot be read, written or believed is not there.
"""

from __future__ import annotations

import marshal
from typing import TYPE_CHECKING

from desire_tui.engine import disk_cache
from desire_tui.engine.codegen.jit.image import Image
from desire_tui.engine.digest import blake2b

if TYPE_CHECKING:
    from desire_tui.engine.codegen.jit.host import Host

_FORMAT = 3
_MARSHAL = 2
"""Python's oldest form that holds all this: every version reads it."""
_PREFIX = "code-"
_BYTES_MOST = 64_000_000
"""Of all files together: a small model takes 10 KB, one of 1,400 equations 1 MB."""
_TRIMMED_EVERY = 32
"""Files written, on average, before those of the folder are counted: that takes 2 µs a file."""

ObjectFile = tuple[bytes, tuple[str, ...]]
"""For LLVM's linker: content, and the functions that others call."""


def find(name: str, host: Host) -> Image | ObjectFile | None:
    """Return code that was kept for a machine like this one."""
    if not disk_cache.holds_only_ours():  # native code is run unseen
        return None
    file = _file(name, host)
    content = disk_cache.read(file, is_used=True)
    if content is None:
        return None
    try:
        form, what = marshal.loads(content)  # noqa: S302 - this user's own file, whole by its check sum
        if form != file:  # another file under this name
            return None
        if len(what) == len(Image._fields):
            return Image(*what)
        content, functions = what
    except (ValueError, TypeError, EOFError):
        return None
    return content, functions


def keep(name: str, host: Host, what: Image | ObjectFile) -> None:
    """Keep some code."""
    file = _file(name, host)
    disk_cache.write(file, marshal.dumps((file, tuple(what)), _MARSHAL))
    if blake2b(file.encode(), digest_size=2).digest()[0] % _TRIMMED_EVERY == 0:
        disk_cache.trim(_PREFIX, _BYTES_MOST)


def _file(name: str, host: Host) -> str:
    made_for = blake2b(f"{_FORMAT} {host.digest}".encode(), digest_size=8).hexdigest()
    return f"{_PREFIX}{name}-{made_for}"
