"""Nothing typed is lost.

Unsaved work goes to a recovery file every second, before a run, at a signal and when the window loses
the focus.

`recovery-<pid>.json` is written to a temporary file and renamed. A file whose process is gone was left by
a crash, a
lost connection or a kill: its tabs are offered at the next start. A normal exit removes it and writes
`session.json`, from which the next start opens the same tabs.
"""

from __future__ import annotations

import contextlib
import json
import os
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from desire_tui.common.paths import state_folder
from desire_tui.engine.text_encoding import ENCODINGS
from desire_tui.engine.user_folders import write_private

VERSION = 1


@dataclass(frozen=True, slots=True)
class SavedTab:
    """A tab as it is stored; `text`, with the line ends of its file; None: the file's own text."""

    path: str | None
    label: str
    text: str | None
    row: int = 0
    column: int = 0
    front: bool = False
    encoding: str | None = None
    stamp: float | None = None
    """The time stamp its file had when it was read or saved."""


@dataclass(frozen=True, slots=True)
class Leftover:
    """What a session that ended badly left."""

    file: Path
    tabs: tuple[SavedTab, ...]


def recovery_file(pid: int | None = None) -> Path:
    """Return a process's recovery file; this one's if none is named."""
    return state_folder() / f"recovery-{pid or os.getpid()}.json"


def session_file() -> Path:
    """Tabs of the last session that ended well."""
    return state_folder() / "session.json"


def store(path: Path, tabs: list[SavedTab], *, sync: bool = True) -> bool:
    """Write tabs; without any, remove the file. False if the folder cannot be written.

    `sync`: they survive a power failure.
    """
    try:
        if tabs:
            text = json.dumps({"version": VERSION, "tabs": [asdict(tab) for tab in tabs]})
            write_private(str(path), text.encode(), sync=sync)
        else:
            path.unlink(missing_ok=True)
    except OSError:
        return False
    return True


def read(path: Path) -> tuple[SavedTab, ...]:
    """Read tabs.

    Raises ValueError for a file that is damaged or of another version, OSError if unreadable.
    """
    stored: Any = json.loads(path.read_text(encoding="utf-8"))
    if not isinstance(stored, dict) or stored.get("version") != VERSION:
        raise ValueError("another version")
    try:
        tabs = tuple(SavedTab(**tab) for tab in stored["tabs"])
    except (TypeError, KeyError) as error:
        raise ValueError("damaged") from error
    if not all(_is_sound(tab) for tab in tabs):
        raise ValueError("damaged")
    return tabs


def _is_sound(tab: SavedTab) -> bool:
    return (
        isinstance(tab.text, str | None)
        and isinstance(tab.path, str | None)
        and isinstance(tab.stamp, float | int | None)
        and tab.encoding in (None, *ENCODINGS)
    )


def leftovers() -> tuple[list[Leftover], list[Path]]:
    """Return what dead sessions left, and recovery files that cannot be read (they are kept)."""
    found, unreadable = [], []
    with contextlib.suppress(OSError):
        for file in sorted(state_folder().glob("recovery-*.json")):
            number = file.stem.rpartition("-")[2]
            if not number.isdecimal() or _is_alive(int(number)):
                continue
            try:
                found.append(Leftover(file, read(file)))
            except (OSError, ValueError):
                unreadable.append(file)
    return found, unreadable


def set_aside(file: Path) -> None:
    """Keep a recovery file that this version cannot read out of the way of the next start."""
    with contextlib.suppress(OSError):
        file.rename(file.with_suffix(".unread"))


def _is_alive(pid: int) -> bool:
    if pid == os.getpid():
        return True
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return not _is_zombie(pid)


def _is_zombie(pid: int) -> bool:
    try:
        return (
            Path(f"/proc/{pid}/stat")
            .read_text(encoding="ascii", errors="replace")
            .rpartition(")")[2]
            .split()[0]
            == "Z"
        )
    except (OSError, IndexError):
        return False
