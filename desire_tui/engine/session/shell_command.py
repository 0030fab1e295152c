"""`sh`: a shell command whose output goes to the console as it comes, and which the user can end.

The command gets a session of its own: ending it ends what it started too, Ctrl-C in the terminal reaches the
app alone, and the command cannot write to the terminal around the app.
"""

from __future__ import annotations

import codecs
import os
import selectors
import signal
import subprocess
from time import monotonic, sleep
from typing import TYPE_CHECKING

from desire_tui.engine.interpreter.host import Interrupted
from desire_tui.engine.session.process_groups import ended_at_exit, send

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

OUTPUT_BYTES_MAX = 1 << 22
"""Of a command's output, what is shown: of more, only the number of bytes."""
_POLL_SECONDS = 0.05
_GRACE_SECONDS = 0.5
"""Between the request to end (SIGTERM) and the end (SIGKILL)."""
_PIECE_BYTES = 1 << 16
_REST_PIECES = 16
"""More than any pipe holds."""


def run_shell(command: str, folder: Path, write: Callable[[str], object], ending: Callable[[], bool]) -> int:
    """Run a command in `folder` and return its status. Interrupted: the user ended it.

    It is over when its shell is: what it left in the background goes on, but is no longer listened to.
    """
    process = subprocess.Popen(  # noqa: S602 - a shell is what the statement is for; permission was asked
        command, shell=True, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT, start_new_session=True, bufsize=0,
    )  # fmt: skip
    with process, ended_at_exit(process.pid):
        try:
            show = _Shown(write)
            for piece in _output(process, ending):
                show(piece)
            show.finish()
        finally:
            if process.poll() is None:
                _end(process)
    if ending():
        raise Interrupted
    return process.returncode


class _Shown:
    """Passes bytes on as text, as far as there is room."""

    def __init__(self, write: Callable[[str], object]) -> None:
        self._write = write
        self._decoder = codecs.getincrementaldecoder("utf-8")("replace")
        self._room = OUTPUT_BYTES_MAX
        self._dropped = 0

    def __call__(self, piece: bytes) -> None:
        shown = piece[: self._room]
        self._room -= len(shown)
        self._dropped += len(piece) - len(shown)
        if text := self._decoder.decode(shown):
            self._write(text)

    def finish(self) -> None:
        """Say how much was dropped."""
        if text := self._decoder.decode(b"", final=True):
            self._write(text)
        if self._dropped:
            self._write(f"\n… and {self._dropped} bytes more that are not shown\n")


def _output(process: subprocess.Popen[bytes], ending: Callable[[], bool]) -> Iterator[bytes]:
    """Yield what the command prints until it is over, or the user ends it."""
    assert process.stdout is not None
    pipe = process.stdout.fileno()
    while not ending():
        if process.poll() is not None:
            yield from _rest(pipe)
            return
        if not _is_readable(pipe, _POLL_SECONDS):
            continue
        piece = os.read(pipe, _PIECE_BYTES)
        if not piece:  # it closed its output and goes on
            sleep(_POLL_SECONDS)
        yield piece


def _rest(pipe: int) -> Iterator[bytes]:
    """Yield what is left in the pipe of a command that is over (its children may write on for ever)."""
    for _ in range(_REST_PIECES):
        if not _is_readable(pipe, 0.0) or not (piece := os.read(pipe, _PIECE_BYTES)):
            return
        yield piece


def _end(process: subprocess.Popen[bytes]) -> None:
    """End the command and what it started: they are asked to, then made to."""
    assert process.stdout is not None
    pipe, deadline = process.stdout.fileno(), monotonic() + _GRACE_SECONDS
    send(process.pid, signal.SIGTERM)
    while monotonic() < deadline:
        if (
            _is_readable(pipe, _POLL_SECONDS)
            and not os.read(pipe, _PIECE_BYTES)
            and process.poll() is not None
        ):
            break  # it is over, and nobody holds its output open
    send(process.pid, signal.SIGKILL)


def _is_readable(pipe: int, seconds: float) -> bool:
    with selectors.DefaultSelector() as selector:  # not `select`: that fails from file number 1024 on
        selector.register(pipe, selectors.EVENT_READ)
        return bool(selector.select(seconds))
