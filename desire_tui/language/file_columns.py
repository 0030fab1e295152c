"""The columns of data files that a program's lines name, for those who type: before it has run, too."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

_DATA = re.compile(r"\bdata\s+(?:'([^']+)'|\"([^\"]+)\")")


def file_columns(lines: Iterable[str], path: Path | None) -> dict[str, str]:
    """Return the tables that `data 'file'` makes in lines of the program at `path`, and a line about each."""
    files = [single or double for line in lines for single, double in _DATA.findall(line)]
    found: dict[str, str] = {}
    if files:  # the desktop, which asks with each word, stands on the screen before NumPy is imported
        from desire_tui.engine.data_files.table_names import tables_beside
        from desire_tui.engine.source import Source

        source = Source("", str(path or ""), path)
        for file in files:
            found |= dict.fromkeys((tables_beside(source, file) or {}).values(), f"column of {file}")
    return found
