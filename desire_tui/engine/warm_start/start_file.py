"""The file of a program's start: plain data under a digest of the text and of the engine that made it.

Whatever is wrong with a file, it is not there.
"""

from __future__ import annotations

import marshal
from typing import Any

from desire_tui.engine import disk_cache
from desire_tui.engine.digest import blake2b
from desire_tui.engine.warm_start.engine_digest import engine_digest

_MARSHAL = 2
"""A form without references between objects, whose bytes depend on the data alone."""
_PREFIX = "start-"
_BYTES_MOST = 16_000_000
"""Of all files together: one of 1,401 equations takes 75 KB."""

Data = tuple[Any, ...]
"""Numbers, texts, None and tuples of these."""


def name_of(text: str) -> str | None:
    """Return the name of the file of a program; None: nothing may be stored or found."""
    engine = engine_digest()
    if engine is None:
        return None
    return _PREFIX + blake2b(text.encode("utf-8", "surrogatepass"), key=engine, digest_size=20).hexdigest()


def read(name: str) -> Data | None:
    """Return what was stored under a name, if nobody else could write it."""
    content = disk_cache.read(name, is_used=True) if disk_cache.holds_only_ours() else None
    if content is None:
        return None
    try:
        form, data = marshal.loads(content)  # noqa: S302 - this user's own file, whole by its check sum
    except (ValueError, TypeError, EOFError):
        return None
    return data if form == name and isinstance(data, tuple) else None


def write(name: str, data: Data) -> None:
    """Store something in place of what there is; older files go if all of them take too much."""
    disk_cache.write(name, marshal.dumps((name, data), _MARSHAL))
    disk_cache.trim(_PREFIX, _BYTES_MOST)
