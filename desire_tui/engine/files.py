"""Reading program files, writing output files; every failure is a message."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

from desire_tui.engine.atomic_file import replacing
from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.source import Source
from desire_tui.engine.text_encoding import NotText, decode

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path
    from typing import IO

    from desire_tui.engine.text_encoding import TextEncoding

PROGRAM_BYTES_MAX = 1 << 26
"""No program is longer; a file that is was named by mistake."""


def read_source(path: Path) -> Source:
    """Read a program, encoded as `text_encoding` knows. DesireError 38: missing, unreadable, not a text."""
    return Source(read_encoded(path)[0], str(path), path)


def read_encoded(path: Path) -> tuple[str, TextEncoding]:
    """Read a program's text, and how it was encoded. DesireError 38."""
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
    return _decoded(data, str(path))


def decoded(data: bytes, name: str) -> str:
    """Return a program's text. DesireError 38 where it is none."""
    return _decoded(data, name)[0]


def _decoded(data: bytes, name: str) -> tuple[str, TextEncoding]:
    try:
        return decode(data)
    except NotText:
        raise DesireError(Diagnostic("file-binary", facts={"path": name})) from None


def write_file(path: Path, write: Callable[[IO[str]], object]) -> None:
    """Replace a text file, whole or not at all. DesireError 106: a full disk, no permission, no folder …."""
    with writing(path), replacing(path) as file:
        write(file)


def write_bytes(path: Path, write: Callable[[IO[bytes]], object], *, sync: bool = True) -> None:
    """Replace a binary file, whole or not at all; `sync` as in `replacing`. DesireError 106."""
    with writing(path), replacing(path, "wb", sync=sync) as file:
        write(file)


@contextmanager
def writing(path: Path) -> Iterator[None]:
    """Report what the system refuses about a file as DesireError 106."""
    try:
        yield
    except OSError as reason:
        facts = {"path": path, "reason": reason.strerror or reason}
        raise DesireError(Diagnostic("file-unwritable", facts=facts)) from None
