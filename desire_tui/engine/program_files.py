"""Opens files for programs: ordinary files only, and no link is followed on the way.

The path was judged before (`session/permissions`). Somebody may put links in its way at any moment since: so
each folder is opened in the one before, and the file in the last.
"""

from __future__ import annotations

import os
from errno import EINVAL, EISDIR, ELOOP
from stat import S_ISBLK, S_ISCHR, S_ISDIR, S_ISFIFO, S_ISLNK, S_ISREG, S_ISSOCK
from typing import IO, TYPE_CHECKING, Any, Literal, overload

if TYPE_CHECKING:
    from pathlib import Path

_FLAGS = {
    "r": os.O_RDONLY,
    "rb": os.O_RDONLY,
    "w": os.O_WRONLY | os.O_CREAT,  # emptied once it is known what it is
    "a": os.O_WRONLY | os.O_CREAT | os.O_APPEND,
}
_FOLDER = getattr(os, "O_PATH", os.O_RDONLY) | os.O_DIRECTORY | os.O_NOFOLLOW | os.O_CLOEXEC
"""A folder that may be entered need not be readable."""
_KINDS = (
    (S_ISLNK, "a link in a circle"),
    (S_ISFIFO, "a named pipe"),
    (S_ISCHR, "a device"),
    (S_ISBLK, "a device"),
    (S_ISSOCK, "a socket"),
)


@overload
def open_for_program(path: Path, mode: Literal["r", "w", "a"]) -> IO[str]: ...
@overload
def open_for_program(path: Path, mode: Literal["rb"]) -> IO[bytes]: ...
def open_for_program(path: Path, mode: Literal["r", "w", "a", "rb"]) -> IO[Any]:
    """Open a file by its resolved path; text is UTF-8. OSError, also for all that is no ordinary file.

    Never waits: a named pipe without a writer would hold the engine for ever.
    """
    flags = _FLAGS[mode] | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_NOCTTY | os.O_CLOEXEC
    folder = _open_folder(path.parent)
    try:
        number = os.open(path.name, flags, 0o666, dir_fd=folder)
    finally:
        os.close(folder)
    try:
        _check(number, path)
        if mode == "w" and str(path) != os.devnull:
            os.ftruncate(number, 0)
        if mode == "rb":
            return os.fdopen(number, mode)
        return os.fdopen(number, mode, encoding="utf-8", errors="replace")
    except BaseException:
        os.close(number)
        raise


def _open_folder(path: Path) -> int:
    """Open a folder, given by its resolved path, component by component. OSError."""
    top, *names = path.parts
    number = os.open(top, _FOLDER)
    for name in names:
        above = number
        try:
            number = os.open(name, _FOLDER, dir_fd=above)
        except OSError:
            if S_ISLNK(os.stat(name, dir_fd=above, follow_symlinks=False).st_mode):
                raise OSError(ELOOP, "a link stands in its way") from None
            raise
        finally:
            os.close(above)
    return number


def _check(number: int, path: Path) -> None:
    """OSError: what was opened is no ordinary file."""
    status = os.fstat(number)
    if S_ISDIR(status.st_mode):
        raise IsADirectoryError(EISDIR, os.strerror(EISDIR))
    if not S_ISREG(status.st_mode) and str(path) != os.devnull:  # into which a look at a script writes
        raise OSError(EINVAL, "it is no ordinary file")


def exists(path: Path) -> bool:
    """Whether something is at a path; what cannot be looked at does not: a name too long, a closed folder."""
    return os.path.exists(path)  # noqa: PTH110 - pathlib's raises errors


def is_folder(path: Path) -> bool:
    """Whether a folder stands at a path that can be looked at."""
    return os.path.isdir(path)  # noqa: PTH112 - as above


def irregular_kind(path: Path) -> str | None:
    """Return what stands at a resolved path in the words of a message; None: a file, a folder, or nothing."""
    try:
        mode = path.lstat().st_mode
    except OSError:
        return None  # whoever opens it reports that
    return next((kind for test, kind in _KINDS if test(mode)), None)
