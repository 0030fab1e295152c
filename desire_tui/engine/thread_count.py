"""How many threads large models run on: all cores, or the `threads` of the user's configuration."""

# ruff: noqa: PTH118, PTH123 - pathlib would add 5 ms to every start

from __future__ import annotations

import os

from desire_tui.engine import user_folders

THREADS_MOST = 64


def cores() -> int:
    """Return how many processor cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def thread_count() -> int:
    """Return the number of threads for one run of a large model, 1 or more.

    What is wrong in the configuration does not count here; the desktop says so when it starts.
    """
    return min(_configured() or cores(), THREADS_MOST)


def _configured() -> int:
    """Return `threads` of the configuration file; 0: all cores."""
    try:
        with open(os.path.join(user_folders.folder("config"), "config.toml"), "rb") as file:
            content = file.read()
    except OSError:
        return 0
    import tomllib  # most people have no such file

    try:
        stored = tomllib.loads(content.decode("utf-8")).get("threads", 0)
    except (tomllib.TOMLDecodeError, UnicodeDecodeError):
        return 0
    return stored if type(stored) is int and 0 <= stored <= THREADS_MOST else 0
