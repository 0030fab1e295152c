"""The terminal, or the browser's connection, goes away in one of several manners: work is kept, the process ends."""

from __future__ import annotations

import fcntl
import os
import pty
import signal
import struct
import subprocess
import sys
import termios
import time
from pathlib import Path
from select import select
from typing import TYPE_CHECKING

import pytest

from tests.long_run import LONG_RUN

if TYPE_CHECKING:
    from collections.abc import Callable

ROOT = Path(__file__).parents[2]
EQUATIONS = 3000
LARGE = "TMAX = 1 | DT = 0.001 | NN = 101\nirule 3\ndrun\nDYNAMIC\n" + "".join(
    f"d/dt y{k} = -{k + 1}*y{k} + sin(y{(k + 1) % EQUATIONS})\n" for k in range(EQUATIONS)
)
"""LLVM takes seconds for this."""
TAKE = "import fcntl, os, sys, termios; fcntl.ioctl(0, termios.TIOCSCTTY, 0); os.execv(sys.argv[1], sys.argv[1:])"
"""Makes its input the terminal that controls the process."""
EDITOR, RUN, OPEN = "\x1be", "\x1b[15~", "\x0f"
PATIENCE_S = 60
"""For a machine with much to do; without an end of its own the process lives for ever."""


class Desktop:
    """The desktop behind pipes or a pseudo-terminal, without a screen; `desire` ends when the test does."""

    def __init__(self, folder: Path, text: str, *, controls: bool = True, served: bool = False) -> None:
        (folder / "lost.src").write_text(text)
        self.state = folder / "state"
        self._served, self.raw = served, b""
        env = {
            **os.environ,
            "TERM": "xterm-256color",
            "XDG_STATE_HOME": str(self.state),
            "PYTHONPATH": str(ROOT),
        }
        env.pop("TMUX", None)
        command = [sys.executable, "-m", "desire_tui", *(["served", "--"] if served else []), "lost.src"]
        if served:
            env |= {
                "TEXTUAL_DRIVER": "desire_tui.desktop.served_driver:ServedWebDriver", "COLUMNS": "80", "ROWS": "24"
            }  # fmt: skip
            self.process = subprocess.Popen(
                command, env=env, cwd=folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE
            )
            assert self.process.stdin is not None
            assert self.process.stdout is not None
            self.writing, self.reading = self.process.stdin.fileno(), self.process.stdout.fileno()
            return
        self.reading, theirs = pty.openpty()
        self.writing = self.reading
        fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 80, 0, 0))

        take = (
            [sys.executable, "-c", TAKE] if controls else []
        )  # else the system sends no signal when it goes away
        self.process = subprocess.Popen(
            [*take, *command],
            env=env,
            cwd=folder,
            stdin=theirs,
            stdout=theirs,
            stderr=theirs,
            start_new_session=True,
        )
        os.close(theirs)

    def read(self, seconds: float) -> None:
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            if select([self.reading], [], [], left)[0]:
                try:
                    self.raw += os.read(self.reading, 65536)
                except OSError:  # it has ended
                    return

    def until(self, condition: Callable[[], object]) -> None:
        end = time.monotonic() + PATIENCE_S
        while not condition():
            assert time.monotonic() < end, self.raw[-600:]
            self.read(0.05)

    def send(self, keys: str) -> None:
        data = keys.encode()
        os.write(self.writing, b"D" + len(data).to_bytes(4, "big") + data if self._served else data)

    def type_something(self) -> None:
        self.until(lambda: b"lost.src" in self.raw and b"F5" in self.raw)
        self.read(0.3)
        self.send(EDITOR)
        self.read(0.2)
        self.send("-- precious\r")
        self.until(self.kept)

    def kept(self) -> list[str]:
        return [
            text for file in self.state.glob("**/recovery-*.json") if "precious" in (text := file.read_text())
        ]

    def children(self) -> list[int]:
        found = subprocess.run(
            ["ps", "-o", "pid=", "--ppid", str(self.process.pid)], capture_output=True, text=True, check=False
        )
        return [int(word) for word in found.stdout.split()]

    def ended_well(self) -> None:
        """It ends and leaves no child; what was typed is kept."""
        children = self.children()
        self.process.wait(PATIENCE_S)
        assert self.kept()
        end = time.monotonic() + PATIENCE_S
        while any(map(is_alive, children)):
            assert time.monotonic() < end
            time.sleep(0.02)

    def close(self) -> None:
        self.process.kill()
        self.process.wait()
        for end in {self.reading, self.writing}:
            try:
                os.close(end)
            except OSError:  # a test has closed it
                continue


def is_alive(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def editing(desktop: Desktop) -> None:
    """Nothing more."""


def running(desktop: Desktop) -> None:
    desktop.send(RUN)
    desktop.until(lambda: b"running" in desktop.raw)


def compiling(desktop: Desktop) -> None:
    desktop.send(RUN)
    desktop.read(0.7)


def in_dialog(desktop: Desktop) -> None:
    desktop.send(OPEN)
    desktop.until(lambda: b"Open" in desktop.raw)


@pytest.fixture
def start(tmp_path: Path):
    opened: list[Desktop] = []

    def begin(text: str, **options: bool) -> Desktop:
        opened.append(Desktop(tmp_path, text, **options))
        return opened[-1]

    yield begin
    for one in opened:
        one.close()


TEXTS = {editing: "x = 1\n", in_dialog: "x = 1\n", running: LONG_RUN, compiling: LARGE}


@pytest.mark.parametrize(
    ("doing", "controls"), [(editing, False), (in_dialog, True), (running, True), (compiling, False)]
)
def test_without_its_terminal_the_desktop_ends(
    start: Callable[..., Desktop], doing: Callable[[Desktop], None], controls: bool
):
    desktop = start(TEXTS[doing], controls=controls)
    desktop.type_something()
    doing(desktop)
    os.close(desktop.reading)
    desktop.ended_well()
    assert desktop.process.returncode == 0


def test_a_terminal_that_takes_nothing_holds_up_no_end(start: Callable[..., Desktop]):
    desktop = start(LONG_RUN)
    desktop.type_something()
    running(desktop)
    time.sleep(1)  # frames fill the terminal's buffer
    desktop.process.send_signal(signal.SIGHUP)
    desktop.ended_well()


@pytest.mark.parametrize("side", ["reading", "writing"])
def test_without_one_of_its_pipes_a_visitors_desktop_ends(start: Callable[..., Desktop], side: str):
    desktop = start(LONG_RUN, served=True)
    desktop.type_something()
    running(desktop)
    stream = desktop.process.stdout if side == "reading" else desktop.process.stdin
    assert stream is not None
    stream.close()
    desktop.ended_well()
    assert desktop.process.returncode == 0
