"""Where the desktop keeps its files, by the operating system's custom (platformdirs)."""

from __future__ import annotations

import os
from pathlib import Path

import platformdirs

APP = "desire-tui"


def config_file() -> Path:
    """Path of the user's configuration; it need not exist."""
    return Path(platformdirs.user_config_dir(APP, appauthor=False)) / "config.toml"


def state_folder() -> Path:
    """Folder for history, session and recovery files; it need not exist."""
    return Path(platformdirs.user_state_dir(APP, appauthor=False))


def examples_folder() -> Path:
    """Folder of the example programs: beside the package in a clone, inside it when installed."""
    inside = Path(__file__).parents[1] / "examples"
    return inside if inside.is_dir() else Path(__file__).parents[2] / "examples"


def full(path: Path, folder: Path | None = None) -> Path:
    """Return the absolute path, `~` and links resolved.

    Relative ones start at `folder` (default: where we are).
    """
    path = path.expanduser()
    return ((folder / path) if folder is not None else path).resolve()


def exists(path: Path) -> bool:
    """Whether there is such a file; one that may not be looked at counts as missing."""
    try:
        return path.exists()
    except OSError:
        return False


def write_safely(path: Path, text: str) -> None:
    """Replace a file's text so that a crash at any moment leaves either the old or the new file.

    Raises OSError if the folder cannot be written.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    beside = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    try:
        with beside.open("w", encoding="utf-8", newline="") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        if path.exists():
            beside.chmod(path.stat().st_mode & 0o7777)
        beside.replace(path)
    finally:
        beside.unlink(missing_ok=True)
