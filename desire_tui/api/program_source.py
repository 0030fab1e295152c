"""What a caller gives as a program: a file's name, or the text itself."""

from __future__ import annotations

from os import fspath
from pathlib import Path
from typing import TYPE_CHECKING

from desire_tui.engine.files import read_source
from desire_tui.engine.source import Source

if TYPE_CHECKING:
    from os import PathLike


def program_source(program: str | PathLike[str]) -> Source:
    """Return the program: a string with a line end or a `|` is its text, anything else names its file.

    TypeError: something else was given. DesireError 38: the file cannot be read.
    """
    try:
        text = fspath(program)
    except TypeError:
        raise TypeError(f"a program is a file name or its text, not {type(program).__name__}") from None
    if isinstance(program, str) and ("\n" in program or "|" in program):
        return Source(text, "<text>")
    return read_source(Path(text))
