"""Program files: reading them whatever they hold, writing what programs made; every failure a message."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.source import Source

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path
    from typing import IO

PROGRAM_BYTES_MAX = 1 << 26
"""No program is longer; a file that is was named by mistake."""


def read_source(path: Path) -> Source:
    """Read a program: UTF-8, or Latin-1 where it is not. DesireError 38: missing, unreadable, not a text."""
    try:
        size = path.stat().st_size
        if size > PROGRAM_BYTES_MAX:
            raise DesireError(Diagnostic("file-binary", facts={"path": path}))
        data = path.read_bytes()
    except FileNotFoundError:
        raise DesireError(Diagnostic("program-missing", facts={"path": path})) from None
    except OSError as reason:
        facts = {"path": path, "reason": reason.strerror or reason}
        raise DesireError(Diagnostic("file-unreadable", facts=facts)) from None
    return Source(decoded(data, str(path)), str(path), path)


def decoded(data: bytes, name: str) -> str:
    """Return a program's text. DesireError 38 where it is none."""
    if b"\0" in data:
        raise DesireError(Diagnostic("file-binary", facts={"path": name}))
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")


def write_file(path: Path, write: Callable[[IO[str]], None]) -> None:
    """Write a text file. DesireError 106 where that fails (a full disk too)."""
    with _writing(path), path.open("w", encoding="utf-8", newline="\n") as file:
        write(file)


def write_bytes(path: Path, write: Callable[[IO[bytes]], None]) -> None:
    """Write a binary file. DesireError 106 where that fails."""
    with _writing(path), path.open("wb") as file:
        write(file)


@contextmanager
def _writing(path: Path) -> Iterator[None]:
    try:
        yield
    except OSError as reason:
        facts = {"path": path, "reason": reason.strerror or reason}
        raise DesireError(Diagnostic("file-unwritable", facts=facts)) from None
