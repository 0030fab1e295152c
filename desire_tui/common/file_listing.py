"""What a file dialog lists for what was typed so far. No widget."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

LISTED_MOST = 300
UP = ".."


@dataclass(frozen=True, slots=True)
class Entry:
    """A line of the list."""

    path: Path
    label: str
    """What is shown, and for a folder ends in a slash."""
    is_folder: bool = False
    is_recent: bool = False


def split_typed(folder: Path, typed: str) -> tuple[Path, str]:
    """Return the folder that a typed path leads to, and the part of a name behind it."""
    head, slash, name = typed.rpartition("/")
    if not slash:
        return (Path.home(), "") if typed == "~" else (folder, typed)
    try:
        start = Path(head + "/").expanduser()
    except RuntimeError:  # ~nobody
        start = Path(head + "/")
    return folder / start, name


def listed(folder: Path, typed: str, recent: Sequence[Path], suffixes: Iterable[str]) -> list[Entry]:
    """Return the files opened last, the folders, and the files that fit what was typed.

    Without a part of a name only files with one of `suffixes` are listed; hidden ones once a dot is typed.
    """
    base, wanted = split_typed(folder, typed)
    found = _recent(folder, typed, recent)
    suffixes = frozenset(suffixes)
    folders, files = [], []
    for name, is_folder in _names(base):
        if (name.startswith(".") and not wanted.startswith(".")) or wanted.casefold() not in name.casefold():
            continue
        if is_folder:
            folders.append(Entry(base / name, f"{name}/", is_folder=True))
        elif wanted or Path(name).suffix.casefold() in suffixes:
            files.append(Entry(base / name, name))
    recents = {entry.path for entry in found}

    def order(entry: Entry) -> tuple[bool, bool, str]:
        name = entry.path.name.casefold()
        return (not name.startswith(wanted.casefold()), entry.path.suffix.casefold() not in suffixes, name)

    up = [] if wanted or base.parent == base else [Entry(base.parent, f"{UP}/", is_folder=True)]
    others = [entry for entry in sorted(files, key=order) if entry.path not in recents]
    by_name = sorted(folders, key=order)
    here = [*others, *by_name] if wanted else [*up, *by_name, *others]
    return [*found, *here][:LISTED_MOST]


def _recent(folder: Path, typed: str, recent: Sequence[Path]) -> list[Entry]:
    if "/" in typed:
        return []
    return [
        Entry(
            path, path.name if path.parent == folder else f"{path.name}  {short(path.parent)}", is_recent=True
        )
        for path in recent
        if typed.casefold() in path.name.casefold()
    ]


def _names(folder: Path) -> list[tuple[str, bool]]:
    try:
        with os.scandir(folder) as entries:
            return [(entry.name, _is_folder(entry)) for entry in entries]
    except OSError:
        return []


def _is_folder(entry: os.DirEntry[str]) -> bool:
    try:
        return entry.is_dir()
    except OSError:
        return False


def short(path: Path) -> str:
    """Return a path with `~` for the home folder."""
    try:
        return f"~/{path.relative_to(Path.home())}".removesuffix("/.")
    except (ValueError, RuntimeError):
        return str(path)
