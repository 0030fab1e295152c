"""The user's folders for what is kept between sessions. Nobody else can read them."""

# ruff: noqa: PTH101, PTH103, PTH111, PTH117, PTH118, PTH120, PTH116 - pathlib would add 5 ms to every start

from __future__ import annotations

import os
import sys
from contextlib import suppress
from stat import S_IMODE, S_ISVTX
from typing import Literal

from desire_tui.engine.atomic_file import replacing

Kind = Literal["cache", "config", "state"]

STATE_VARIABLE = "DESIRE_STATE"
"""Environment variable by which `desire serve` keeps the owner's unsaved work and history from visitors."""
_APP = "desire-tui"
_PLACES: dict[Kind, tuple[str, str]] = {
    "cache": ("XDG_CACHE_HOME", "~/.cache"),
    "config": ("XDG_CONFIG_HOME", "~/.config"),
    "state": ("XDG_STATE_HOME", "~/.local/state"),
}
_OTHERS_WRITE = 0o022


def folder(kind: Kind) -> str:
    """Return a folder's path; it need not exist. A variable that names no absolute path does not count."""
    if kind == "state" and (apart := os.environ.get(STATE_VARIABLE)):
        return apart
    variable, usual = _PLACES[kind]
    if sys.platform != "linux":
        import platformdirs

        made = {
            "cache": platformdirs.user_cache_dir,
            "config": platformdirs.user_config_dir,
            "state": platformdirs.user_state_dir,
        }[kind](_APP, appauthor=False)
        return made if os.path.isabs(made) else os.path.join(os.path.expanduser("~"), made)
    named = os.environ.get(variable, "")
    return os.path.join(named if os.path.isabs(named) else os.path.expanduser(usual), _APP)


def ignored_variables() -> list[str]:
    """Return a sentence for each variable that does not count: it would put private files anywhere."""
    return [
        f"{variable}={named} is no absolute path: {usual} is used"
        for variable, usual in _PLACES.values()
        if (named := os.environ.get(variable, "")) and not os.path.isabs(named)
    ]


def make_private(path: str) -> None:
    """Make a folder that only its owner can enter; one of ours that is open to others is closed. OSError."""
    os.makedirs(path, mode=0o700, exist_ok=True)
    status = os.stat(path)
    if status.st_uid == os.getuid() and S_IMODE(status.st_mode) & 0o077:
        with suppress(OSError):
            os.chmod(path, 0o700)


def write_private(path: str, content: bytes, *, sync: bool = True) -> None:
    """Replace a file that only its owner can read, in a folder that only he can enter. OSError."""
    make_private(os.path.dirname(path))
    with replacing(path, "wb", sync=sync) as file:
        os.fchmod(file.fileno(), 0o600)
        file.write(content)


def is_ours_alone(path: str) -> bool:
    """Whether nobody else (but root) can write a folder or put another in its place."""
    path = os.path.realpath(path)
    while True:
        try:
            status = os.stat(path)
        except OSError:
            return False
        if status.st_uid not in (os.getuid(), 0):
            return False
        if status.st_mode & _OTHERS_WRITE:
            return False
        above = os.path.dirname(path)
        if above == path:
            return True
        path = above
        with suppress(OSError):
            status = os.stat(path)
            if status.st_mode & S_ISVTX and status.st_uid in (os.getuid(), 0):
                return True  # what is ours in such a folder, others cannot rename
