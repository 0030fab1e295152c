"""Gives a file new content where it stands, with a copy of the old beside it until that is done.

For files that no other file may take the place of: they have several names (hard links), or an owner or
attributes that a new file would not get.
"""

# ruff: noqa: PTH108, PTH120, PTH123 - pathlib takes 5 ms to import

from __future__ import annotations

import os
from contextlib import suppress
from errno import EINVAL, EOPNOTSUPP
from typing import IO

_PIECE = 1 << 20


def overwrite(path: str, content: str, spare: str) -> None:
    """Write what stands in the file `content` into the file `path`. OSError: the old content is still there.

    Or it is in the file `spare`, which the error then names: where the system fails twice, or is killed.
    """
    _copy(path, spare)
    try:
        _pour(content, path)
    except BaseException as error:
        try:
            _pour(spare, path)
        except OSError as second:
            reason = f"{second.strerror}; what it held is kept in {spare}"
            raise OSError(second.errno, reason, path) from error
        os.unlink(spare)
        raise
    os.unlink(spare)


def _copy(path: str, spare: str) -> None:
    try:
        with open(path, "rb") as old, open(spare, "xb") as new:
            os.fchmod(new.fileno(), 0o600)
            _pass_on(old, new)
        _keep_name(os.path.dirname(spare))
    except BaseException:
        with suppress(OSError):
            os.unlink(spare)
        raise


def _pour(source: str, path: str) -> None:
    """Write over a file's bytes. It becomes shorter last: until then its room is its own."""
    with open(source, "rb") as new, open(path, "r+b") as file:
        size = os.fstat(new.fileno()).st_size
        if size > os.fstat(file.fileno()).st_size:
            _allot(file, size)
        _pass_on(new, file)
        file.truncate(size)
        os.fsync(file.fileno())


def _allot(file: IO[bytes], size: int) -> None:
    """OSError before the first byte is written, where the disk has no room for the last."""
    before = os.fstat(file.fileno()).st_size
    try:
        os.posix_fallocate(file.fileno(), 0, size)
    except AttributeError:  # macOS
        pass
    except OSError as error:
        with suppress(OSError):
            file.truncate(before)
        if error.errno not in (EINVAL, EOPNOTSUPP):  # file systems without it
            raise


def _pass_on(source: IO[bytes], to: IO[bytes]) -> None:
    while piece := source.read(_PIECE):
        to.write(piece)
    to.flush()
    os.fsync(to.fileno())


def _keep_name(folder: str) -> None:
    """Write a folder's names to the disk, as far as the system lets us."""
    with suppress(OSError):
        number = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(number)
        finally:
            os.close(number)
