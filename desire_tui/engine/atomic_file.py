"""Files are replaced whole or not at all: a crash or a full disk leaves the old content.

A file keeps its names, owner, permissions and attributes: where a new one could not have them all, the old
one is written in place.
"""

# ruff: noqa: PTH100, PTH101, PTH103, PTH105, PTH108, PTH116, PTH118, PTH120, PTH123 - pathlib takes 5 ms to import

from __future__ import annotations

import os
from contextlib import contextmanager, suppress
from errno import EACCES
from stat import S_IMODE, S_ISREG
from typing import IO, TYPE_CHECKING, Any, Literal, overload

from desire_tui.engine.file_in_place import overwrite

if TYPE_CHECKING:
    from collections.abc import Iterator
    from contextlib import AbstractContextManager
    from os import PathLike

    AnyPath = str | PathLike[str]

_SYSTEMS_OWN = ("security.", "trusted.")
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
    ends stay as written. Links are followed and kept. Pipes and devices are written directly.
    `sync`: the content is on the disk before it gets its name, so that it survives a power failure too.
    OSError.
    """
    return _replacing(os.fspath(path), mode, make_folder=make_folder, sync=sync)


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
    has_room = before is None or os.access(folder, os.W_OK | os.X_OK)
    temporary = os.path.join(folder if has_room else _spare_folder(), f".desire-{os.urandom(6).hex()}.tmp")
    try:
        with _opened(temporary, mode.replace("w", "x")) as file:
            takes_place = before is None or (has_room and _take_over(before, target, temporary))
            if not takes_place:
                os.chmod(temporary, 0o600)
            yield file
            if sync or not takes_place:
                file.flush()
                os.fsync(file.fileno())
        if takes_place:
            os.replace(temporary, target)
        else:
            overwrite(target, temporary, _spare_name(target, temporary))
            os.unlink(temporary)
    except BaseException:
        with suppress(OSError):
            os.unlink(temporary)
        raise


def _spare_name(target: str, temporary: str) -> str:
    """Name the copy of the old content so that it is recognised after a crash."""
    mark = temporary.removesuffix(".tmp").rpartition("-")[2]
    return os.path.join(os.path.dirname(temporary), f"{os.path.split(target)[1]}.{mark}.old")


def _spare_folder() -> str:
    """Return where a file's content can wait if its own folder takes no new files."""
    import tempfile

    return tempfile.gettempdir()


def _opened(path: str, mode: str) -> IO[Any]:
    return open(path, mode) if "b" in mode else open(path, mode, encoding="utf-8", newline="")


def _is_closed(path: str) -> bool:
    return not os.path.abspath(path).startswith(_OPEN_ALREADY)


def _status(path: str) -> os.stat_result | None:
    try:
        return os.stat(path)
    except FileNotFoundError:
        return None


def _take_over(before: os.stat_result, target: str, temporary: str) -> bool:
    """Make the new file what the old one was; False if that cannot be."""
    if before.st_nlink > 1:
        return False
    try:
        made = os.stat(temporary)
        if (made.st_uid, made.st_gid) != (before.st_uid, before.st_gid):
            os.chown(temporary, before.st_uid, before.st_gid)
        os.chmod(temporary, S_IMODE(before.st_mode))
        _take_attributes(target, temporary)
    except OSError:
        return False
    return True


def _take_attributes(target: str, temporary: str) -> None:
    """Copy extended attributes, access lists too; the system sets those of its own. OSError."""
    if not hasattr(os, "listxattr"):
        return
    try:
        names = os.listxattr(target)
    except OSError:
        return  # a file system without them
    for name in names:
        if not name.startswith(_SYSTEMS_OWN):
            os.setxattr(temporary, name, os.getxattr(target, name))
