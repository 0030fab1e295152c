"""What the columns of a file are called in a program, and which a file has, without reading all of it."""

from __future__ import annotations

import os
import re
import unicodedata
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

from desire_tui.engine.data_files.data_file import EXCEL_ENDINGS, first_line_names, time_column
from desire_tui.engine.program_files import open_for_program
from desire_tui.engine.syntax.reserved import RESERVED
from desire_tui.engine.text_encoding import NotText, decode

if TYPE_CHECKING:
    from collections.abc import Iterable

    from desire_tui.engine.source import Source

_NOT_IN_NAMES = re.compile(r"[^A-Za-z0-9]+")
_HEAD_BYTES = 1 << 16
"""The names of columns stand in so many bytes, or are not looked for."""


def table_names(columns: Iterable[str]) -> dict[str, str]:
    """Return the name that each column's table has in a program; the column of the time has none."""
    given = list(columns)
    time = time_column(given)
    return {column: _name(column) for column in given if column != time}


def _name(column: str) -> str:
    """Return a name of the language: `Höhe` is `Hohe`, `end`, which is a word of the language, `end_data`."""
    plain = unicodedata.normalize("NFKD", column.replace("ß", "ss")).encode("ascii", "ignore").decode()
    name = _NOT_IN_NAMES.sub("_", plain).strip("_")
    if not name[:1].isalpha():
        name = f"column_{name}".rstrip("_")
    return f"{name}_data" if name in RESERVED else name


def tables_beside(source: Source, file: str) -> dict[str, str] | None:
    """Return the table's name of each column of a file that a program names; None: that cannot be told."""
    columns = columns_beside(source, file)
    return None if columns is None else table_names(columns)


def columns_beside(source: Source, file: str) -> tuple[str, ...] | None:
    """Return the columns of a file that a program names; None: that cannot be told.

    It cannot be told where the program has no folder, or the file is not below it or hidden (nobody is asked
    for permission here), is none of text, or does not begin as one of measurements.
    """
    if source.path is None:
        return None
    try:
        folder = os.path.realpath(source.path.expanduser().absolute().parent)
        path = Path(os.path.realpath(Path(folder) / file.strip()))
        if not path.is_relative_to(folder) or path.suffix.lower() in EXCEL_ENDINGS:
            return None
        if any(part.startswith(".") for part in path.relative_to(folder).parts):
            return None
        status = path.stat()
    except (OSError, ValueError, RuntimeError):
        return None
    return _names_in(path, status.st_mtime_ns, status.st_size)


@lru_cache(maxsize=64)
def _names_in(path: Path, changed: int, size: int) -> tuple[str, ...] | None:
    """Return the names in a file's first lines; it is read again when its time or its size is another."""
    del changed, size
    try:
        with open_for_program(path, "rb") as file:
            begin: bytes = file.read(_HEAD_BYTES)
        text = decode(begin[: begin.rfind(b"\n") + 1])[0]
    except (OSError, NotText):
        return None
    lines = (line.strip("\r") for line in text.split("\n"))
    head = next((line for line in lines if line.strip() and not line.strip().startswith("#")), "")
    found = first_line_names(head)
    return None if found is None else tuple(found[1])
