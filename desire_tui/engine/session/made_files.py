"""Which files a program made: it may write those again, also when it is run another day."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING

from desire_tui.engine import user_folders

if TYPE_CHECKING:
    from pathlib import Path

_PROGRAMS_MAX = 500
_FILES_MAX = 200
"""Of each program: more are asked for again."""


class MadeFiles:
    """Files by the program that made them, kept in the user's state folder.

    Programs without a file are remembered as long as the session lasts. A record that cannot be read or
    written is no error: what it does not know is asked for.
    """

    def __init__(self) -> None:
        self._session: set[tuple[str, str]] = set()

    def has(self, program: Path | None, file: Path) -> bool:
        """Whether the program made the file."""
        key = (str(program), str(file))
        return key in self._session or (program is not None and key[1] in _read().get(key[0], []))

    def add(self, program: Path | None, file: Path) -> None:
        """Remember that the program makes the file."""
        key = (str(program), str(file))
        if key in self._session:
            return
        self._session.add(key)
        if program is None:
            return
        record = _read()
        files = record.pop(key[0], [])
        if key[1] not in files:
            files.append(key[1])
        record[key[0]] = files[-_FILES_MAX:]  # the newest program last
        kept = dict(list(record.items())[-_PROGRAMS_MAX:])
        with suppress(OSError):
            import json

            user_folders.write_private(_path(), json.dumps(kept).encode(), sync=False)


def _path() -> str:
    return f"{user_folders.folder('state')}/made-files.json"


def _read() -> dict[str, list[str]]:
    import json  # few programs make files: 2 ms

    try:
        with open(_path(), "rb") as file:  # noqa: PTH123 - the path is a text
            stored = json.load(file)
    except (OSError, ValueError):
        return {}
    if not isinstance(stored, dict):
        return {}
    return {program: files for program, files in stored.items() if isinstance(files, list)}
