"""How many threads large models run on: all cores, or the `threads` of the user's configuration."""

# ruff: noqa: PTH118, PTH123 - pathlib would add 5 ms to every start

from __future__ import annotations

import os
from contextlib import contextmanager
from typing import TYPE_CHECKING

from desire_tui.engine import user_folders

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

THREADS_MOST = 64


_runs_at_once: list[int] = []
_listeners: list[Callable[[], object]] = []


def cores() -> int:
    """Return how many processor cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def thread_count() -> int:
    """Return the number of threads for one run of a large model, 1 or more.

    Runs that go on at once share the threads. What is wrong in the configuration does not count here; the
    desktop says so when it starts.
    """
    return max(min(_configured() or cores(), THREADS_MOST) // max(sum(_runs_at_once), 1), 1)


@contextmanager
def runs_at_once(runs: int) -> Iterator[None]:
    """Tell that so many runs go on side by side, in this process or in others like it."""
    _runs_at_once.append(runs)
    _tell()
    try:
        yield
    finally:
        _runs_at_once.remove(runs)
        _tell()


def when_it_changes(listener: Callable[[], object]) -> None:
    """Call a function whenever `thread_count` may have changed."""
    _listeners.append(listener)


def _tell() -> None:
    for listener in _listeners:
        listener()


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
