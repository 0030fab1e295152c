"""Where the desktop keeps its files, by the operating system's custom (platformdirs)."""

from __future__ import annotations

import os
from pathlib import Path

from desire_tui.engine import user_folders


def config_file() -> Path:
    """Path of the user's configuration; it need not exist."""
    return Path(user_folders.folder("config")) / "config.toml"


def state_folder() -> Path:
    """Folder for history, session and recovery files; it need not exist."""
    return Path(user_folders.folder("state"))


def examples_folder() -> Path:
    """Folder of the example programs: beside the package in a clone, inside it when installed."""
    inside = Path(__file__).parents[1] / "examples"
    return inside if inside.is_dir() else Path(__file__).parents[2] / "examples"


def full(path: Path, folder: Path | None = None) -> Path:
    """Return the absolute path, `~` and links resolved.

    Relative ones start at `folder` (default: where we are).
    """
    path = Path(os.path.expanduser(path))  # noqa: PTH111 - ~nobody is no error
    return ((folder / path) if folder is not None else path).resolve()


def can_name_a_file(name: str) -> bool:
    """Whether a file could be called so; a NUL or half a character is a ValueError everywhere."""
    try:
        return b"\0" not in os.fsencode(name)
    except UnicodeEncodeError:
        return False


def exists(path: Path) -> bool:
    """Whether there is such a file; one that may not be looked at counts as missing."""
    try:
        return path.exists()
    except OSError:
        return False
