"""Files are replaced whole or not at all: a crash or a full disk leaves the old content."""

# ruff: noqa: PTH100, PTH101, PTH103, PTH105, PTH108, PTH116, PTH118, PTH120, PTH123 - pathlib takes 5 ms to import

from __future__ import annotations

import os
from contextlib import contextmanager, suppress
from errno import EACCES
from stat import S_IMODE, S_ISREG
from typing import IO, TYPE_CHECKING, Any, Literal, overload

if TYPE_CHECKING:
    from collections.abc import Iterator
    from contextlib import AbstractContextManager
    from os import PathLike

    AnyPath = str | PathLike[str]

_OPEN_ALREADY = ("/dev/fd/", "/dev/std", "/proc/")
"""Names of files that a process has open: whoever opened them goes on with the file that is there."""


@overload
def replacing(
    path: AnyPath, mode: Literal["w"] = "w", *, make_folder: bool = False, sync: bool = True
) -> AbstractContextManager[IO[str]]: ...
@overload
def replacing(
    path: AnyPath, mode: Literal["wb"], *, make_folder: bool = False, sync: bool = True
) -> AbstractContextManager[IO[bytes]]: ...
def replacing(
    path: AnyPath, mode: Literal["w", "wb"] = "w", *, make_folder: bool = False, sync: bool = True
) -> AbstractContextManager[IO[Any]]:
    """Open a file whose content takes the place of `path`'s when the block ends well.

    Until then it is a temporary file in the same folder, removed when the block raises. Text is UTF-8, line
    ends stay as written. Links are followed; permissions are kept. Pipes and devices are written directly.
    `sync`: the content is on the disk before it gets its name, so that it survives a power failure too.
    OSError.
    """
    return _replacing(os.fspath(path), mode, make_folder=make_folder, sync=sync)


def replace_text(path: AnyPath, text: str) -> None:
    """Replace a file's text; a missing folder is made. OSError."""
    with replacing(path, make_folder=True) as file:
        file.write(text)


@contextmanager
def _replacing(path: str, mode: str, *, make_folder: bool, sync: bool) -> Iterator[IO[Any]]:
    before = _status(path)
    if before is not None and not (S_ISREG(before.st_mode) and _is_closed(path)):
        with _opened(path, mode) as file:
            yield file
        return
    if before is not None and not os.access(path, os.W_OK):
        # a rename asks for no permission of the file that it replaces
        raise PermissionError(EACCES, os.strerror(EACCES), path)
    target = os.path.realpath(path)
    folder = os.path.dirname(target)
    if make_folder:
        os.makedirs(folder, exist_ok=True)
    temporary = os.path.join(folder, f".desire-{os.urandom(6).hex()}.tmp")
    try:
        with _opened(temporary, mode.replace("w", "x")) as file:
            if before is not None:
                _take_over(before, temporary)
            yield file
            if sync:
                file.flush()
                os.fsync(file.fileno())
        os.replace(temporary, target)
    except BaseException:
        with suppress(OSError):
            os.unlink(temporary)
        raise


def _opened(path: str, mode: str) -> IO[Any]:
    return open(path, mode) if "b" in mode else open(path, mode, encoding="utf-8", newline="")


def _is_closed(path: str) -> bool:
    return not os.path.abspath(path).startswith(_OPEN_ALREADY)


def _status(path: str) -> os.stat_result | None:
    try:
        return os.stat(path)
    except FileNotFoundError:
        return None


def _take_over(before: os.stat_result, temporary: str) -> None:
    """Give the new file the owner and permissions of the old one, as far as the system lets us."""
    with suppress(OSError, AttributeError):  # Windows has no chown
        os.chown(temporary, before.st_uid, before.st_gid)
    with suppress(OSError):
        os.chmod(temporary, S_IMODE(before.st_mode))
