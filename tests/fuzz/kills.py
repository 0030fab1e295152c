"""`kill -9` at random moments to the desktop in a terminal, while somebody types, saves and runs.

What stood in the editor a moment before must be in the file or in what the next start offers to restore, and the
file must be the old or a saved text, whole. A desktop is a fork of the process that tries inputs, which has
imported everything: no time goes into starting Python.
"""

from __future__ import annotations

import fcntl
import json
import os
import pty
import re
import shutil
import signal
import struct
import sys
import termios
import time
from pathlib import Path
from select import select
from typing import TYPE_CHECKING, NoReturn
from unittest.mock import patch
from zlib import crc32

from tests.long_run import LONG_RUN

if TYPE_CHECKING:
    from collections.abc import Callable
    from random import Random

BEAT_SECONDS = 0.05
"""So often the desktop notes what stands in its editor. It is late where the machine has much to do, as checkpoints are."""
LOST_SECONDS = 1.0
"""So much typing may be lost, by the desktop's own clock."""
ACTIONS_EACH_BEAT = 3
RESTORED_EVERY = 8
"""After one kill in so many somebody starts again and restores the work."""
PATIENCE_SECONDS = 100.0
EDITOR, TOP, F5, CTRL_S = "\x1b[<0;30;4M\x1b[<0;30;4m", "\x1b[1;5H", "\x1b[15~", "\x13"
_WORD = re.compile(r"\bn(\d{4})\b")
_TYPED = re.compile(r"(-- (n\d{4} )*(n\d{0,4})?|-?-?)\Z")


def generate(rng: Random) -> list[str]:
    """Return what is done about every 20 ms: a word typed, a pause, a save or a run; then comes the signal."""
    actions = ["word", *rng.choices(("word", "pause", "save"), (20, 10, 0.7), k=rng.randint(1, 150))]
    if rng.random() < 0.4:  # the keys belong to the graph or the console afterwards
        actions += ["run", *["pause"] * rng.randint(0, 30)]
    return actions


def check(actions: list[str]) -> None:
    """Type, kill, look at the files; perhaps start again and restore."""
    folder = Path.cwd()
    shutil.rmtree(folder / "state", ignore_errors=True)
    file, beats = folder / "program.src", folder / "beats.log"
    file.write_text(LONG_RUN, "utf-8")
    beats.write_text("")
    desktop = _Desktop(folder, file.name, beats)
    try:
        desktop.until(beats.read_text)
        desktop.send(EDITOR + TOP + "-- ")
        _do(desktop, actions, beats)
    finally:
        desktop.kill()
    _whole(file)
    recovered = _recovered(folder)
    for text in recovered:
        assert text.endswith(LONG_RUN), "recovery has another text"
    kept = max((_newest(text) for text in (file.read_text("utf-8"), *recovered)), default=-1)
    noted = [line.split() for line in beats.read_text().splitlines(keepends=True) if line.endswith("\n")]
    last = float(noted[-1][0]) - LOST_SECONDS - BEAT_SECONDS  # it is being written for some of it
    must = max((int(newest) for t, newest in noted if float(t) < last), default=-1)
    assert kept >= must, f"word {must} was there long before the signal, {kept} is kept"
    if recovered and crc32(repr(actions).encode()) % RESTORED_EVERY == 0:
        _restored(folder, file.name, _newest(recovered[0]))
    shutil.rmtree(folder / "state", ignore_errors=True)


class _Desktop:
    """A fork of this process that opens the desktop in a pseudo-terminal; nobody looks at its screen."""

    def __init__(self, folder: Path, name: str, beats: Path) -> None:
        _import_all()
        self._pid, self._terminal = pty.fork()
        if self._pid == 0:
            _open_desktop(folder, name, beats)
        fcntl.ioctl(self._terminal, termios.TIOCSWINSZ, struct.pack("HHHH", 30, 100, 0, 0))

    def send(self, keys: str) -> None:
        os.write(self._terminal, keys.encode())

    def read(self, seconds: float) -> None:
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            if select([self._terminal], [], [], left)[0]:
                os.read(self._terminal, 65536)

    def until(self, condition: Callable[[], object]) -> None:
        end = time.monotonic() + PATIENCE_SECONDS
        while not condition():
            assert time.monotonic() < end, "it does not start"
            self.read(0.02)

    def kill(self) -> None:
        os.kill(self._pid, signal.SIGKILL)
        os.waitpid(self._pid, 0)
        os.close(self._terminal)


def _import_all() -> None:
    import desire_tui.app
    import desire_tui.desktop.terminal_driver
    import desire_tui.engine.session.session
    import desire_tui.launch  # noqa: F401


def _open_desktop(folder: Path, name: str, beats: Path) -> NoReturn:
    """Be the desktop, noting the newest word of the text all the time."""
    from desire_tui.app import DesireApp
    from desire_tui.launch import open_desktop

    os.environ.update(
        TERM="xterm-256color", COLORTERM="truecolor", XDG_CONFIG_HOME=str(folder / "config"),
        XDG_STATE_HOME=str(folder / "state"),
    )  # fmt: skip
    sys.stdin = sys.__stdin__ = open(0, closefd=False)  # noqa: SIM115 - multiprocessing has closed it
    sys.stdout = sys.__stdout__ = open(1, "w", closefd=False)  # noqa: SIM115
    sys.stderr = sys.__stderr__ = open(2, "w", closefd=False)  # noqa: SIM115
    noted = beats.open("a", buffering=1)
    show = DesireApp._show

    def shown(app):
        show(app)
        app.main_screen.set_interval(
            BEAT_SECONDS, lambda: noted.write(f"{time.monotonic()} {_newest(app.editor.front.text)}\n")
        )

    try:
        with patch.object(DesireApp, "_show", shown):
            open_desktop((name,))
    finally:
        os._exit(1)


def _do(desktop: _Desktop, actions: list[str], beats: Path) -> None:
    """Do it all, no faster than the desktop can follow."""
    number = 0
    for k, action in enumerate(actions):
        if k % ACTIONS_EACH_BEAT == 0:
            size = beats.stat().st_size
            desktop.until(lambda size=size: beats.stat().st_size > size)
        if action == "word":
            desktop.send(f"n{number:04} ")
            number += 1
        elif action in {"save", "run"}:
            desktop.send(CTRL_S if action == "save" else F5)
        desktop.read(0.02)


def _newest(text: str) -> int:
    return max(map(int, _WORD.findall(text)), default=-1)


def _whole(file: Path) -> None:
    text = file.read_text("utf-8")
    assert text.endswith(LONG_RUN), "the file is cut"
    assert _TYPED.match(text.removesuffix(LONG_RUN)), "the file is neither old nor typed"


def _recovered(folder: Path) -> list[str]:
    found = [json.loads(file.read_text("utf-8")) for file in folder.glob("state/**/recovery-*.json")]
    return [tab["text"] for kept in found for tab in kept["tabs"] if tab["text"] is not None]


def _restored(folder: Path, name: str, newest: int) -> None:
    """Start again: the work is offered, and restored it is on the screen."""
    from tests.app.test_terminal import Terminal

    desktop = Terminal(folder, name, rows=16, columns=900)  # the whole line is seen
    try:
        desktop.until(lambda: "Unsaved work found" in desktop.text)
        desktop.answer("r", "Unsaved work found")
        desktop.until(lambda: _newest(desktop.text) == newest)
    finally:
        desktop.child.close(force=True)
