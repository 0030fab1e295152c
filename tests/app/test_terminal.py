"""The real program in a real (pseudo-)terminal, as a user meets it."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import termios
import time
from pathlib import Path
from typing import TYPE_CHECKING

import pexpect
import pyte
import pytest

from tests.long_run import LONG_RUN

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

ROOT = Path(__file__).parents[2]
F5, F10 = "\x1b[15~", "\x1b[21~"
CTRL_A, CTRL_L, CTRL_N, CTRL_Q, CTRL_S = "\x01", "\x0c", "\x0e", "\x11", "\x13"
PATIENCE_S = 120


class Terminal:
    """Desire in a pseudo-terminal, its screen followed by pyte."""

    def __init__(
        self, folder: Path, *files: str, rows: int = 30, columns: int = 100, shell: tuple[str, ...] = ()
    ) -> None:
        env = {
            **os.environ, "TERM": "xterm-256color", "COLORTERM": "truecolor", "XDG_CONFIG_HOME": str(folder / "config"),
            "XDG_STATE_HOME": str(folder / "state"), "PYTHONPATH": str(ROOT),
        }  # fmt: skip
        for name in (
            "TMUX",
            "COLUMNS",
            "LINES",
            "NO_COLOR",
        ):  # tests in one process leave some of these behind
            env.pop(name, None)
        self.screen = pyte.Screen(columns, rows)
        self.stream = pyte.ByteStream(self.screen)
        self.raw = bytearray()
        command, *arguments = *shell, sys.executable, "-m", "desire_tui", *files
        self.child = pexpect.spawn(command, arguments, env=env, cwd=str(folder), dimensions=(rows, columns))
        self.child.delaybeforesend = None
        self.child.ptyproc.delayafterterminate = (
            0.5  # on a machine with much to do even SIGKILL takes its time
        )
        self.modes_before = termios.tcgetattr(self.child.child_fd)

    def read(self, seconds: float = 0.05) -> None:
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            try:
                data = self.child.read_nonblocking(65536, timeout=left)
            except pexpect.TIMEOUT:
                return
            except pexpect.EOF:
                return
            self.raw += data
            self.stream.feed(data)

    @property
    def text(self) -> str:
        return "\n".join(self.screen.display)

    def until(self, condition: Callable[[], object]) -> None:
        end = time.monotonic() + PATIENCE_S
        while not condition():
            assert time.monotonic() < end, (self.text, bytes(self.raw[-600:]), self.child.isalive())
            self.read()

    def answer(self, key: str, question: str) -> None:
        """Answer a question that is shown; it counts only some time after it came, on a slow machine later."""
        pause = 1.5
        while question in self.text and self.child.isalive():
            end = time.monotonic() + pause
            while time.monotonic() < end:
                self.read(end - time.monotonic())
            self.send(key)
            answered = time.monotonic() + 2 * pause
            while question in self.text and self.child.isalive() and time.monotonic() < answered:
                self.read()
            pause *= 2
            assert pause < PATIENCE_S, self.text

    def send(self, text: str) -> None:
        self.child.send(text)

    def resize(self, rows: int, columns: int) -> None:
        self.screen.resize(rows, columns)
        self.child.setwinsize(rows, columns)

    @property
    def dots(self) -> int:
        """Cells with braille dots."""
        return sum("\u2801" <= character <= "\u28ff" for character in self.text)


@pytest.fixture
def terminal(tmp_path: Path) -> Iterator[Callable[..., Terminal]]:
    opened: list[Terminal] = []

    def start(*files: str, shell: tuple[str, ...] = (), **size: int) -> Terminal:
        opened.append(Terminal(tmp_path, *files, shell=shell, **size))
        return opened[-1]

    yield start
    for one in opened:
        one.child.close(force=True)


def children_of(pid: int) -> list[str]:
    found = subprocess.run(
        ["ps", "-o", "pid=", "--ppid", str(pid)], capture_output=True, text=True, check=False
    )
    return found.stdout.split()


def test_a_session(terminal: Callable[..., Terminal], tmp_path: Path):
    (tmp_path / "empty.src").write_text("")
    screen = terminal("empty.src")
    screen.until(lambda: "empty.src" in screen.text and "F5" in screen.text)
    screen.read(0.3)

    # type a program and run it, faster than the screen follows; the editor has the keys because the tab is empty
    for line in LONG_RUN.splitlines():
        screen.send(line + "\x1b[D\x1b[C\r")  # left, right, return
    screen.send(F5)

    # the curve grows before the run ends
    screen.until(lambda: screen.dots > 3)
    screen.until(
        lambda: "8" in screen.text.splitlines()[8][:3]
    )  # the first dots do not wait for the last row
    before = screen.dots
    screen.until(lambda: screen.dots > before + 3)
    assert re.search(r"running 1 ", screen.text)

    # pause: nothing grows any more; resume: it does; end
    screen.send("\x03")
    screen.until(lambda: "Paused" in screen.text)
    screen.read(0.3)
    paused = screen.dots
    screen.read(0.5)
    assert screen.dots == paused
    screen.send("\r")
    screen.until(lambda: screen.dots > paused)
    screen.send("\x03")
    screen.until(lambda: "Paused" in screen.text)
    screen.send(" \r")
    screen.until(lambda: "ended" in screen.text)

    # resize
    screen.resize(24, 80)
    screen.until(lambda: "F5" in screen.screen.display[23] and "vs. t" in screen.text)
    assert "empty.src" in screen.screen.display[0]

    # edit and run again
    screen.read(0.3)
    screen.send("\x1be")  # Alt+E: the editor
    screen.send("\x1b[1;5H")  # Ctrl+Home does nothing harmful
    screen.send("\x1b[5~\x1b[5~\x1b[H-- edited\r")
    screen.until(lambda: "-- edited" in screen.text)
    screen.send(F5)
    screen.until(lambda: re.search(r"running 1 ", screen.text))

    # quit during the run: the guard asks, discarding leaves within a second or so
    children = children_of(screen.child.pid)
    screen.send(CTRL_Q)
    screen.until(lambda: "Unsaved work" in screen.text)
    screen.answer("d", "Unsaved work")
    screen.child.expect(pexpect.EOF, timeout=PATIENCE_S)
    screen.raw += screen.child.before or b""
    screen.child.wait()
    assert screen.child.exitstatus == 0
    assert len(children) == 1  # the watchdog
    assert not Path(f"/proc/{children[0]}").exists()
    assert_restored(bytes(screen.raw))


def test_what_is_typed_while_the_desktop_opens_waits_for_it(
    terminal: Callable[..., Terminal], tmp_path: Path
):
    (tmp_path / "a.src").write_text("x = 1\n")
    screen = terminal("a.src")
    screen.send(CTRL_N + "early\r\x1b[200~pasted\x1b[201~")
    screen.until(lambda: "untitled-1" in screen.text and "early" in screen.text and "pasted" in screen.text)
    screen.until(lambda: screen.text.index("early") < screen.text.index("pasted"))
    assert "internal error" not in screen.text


def test_what_is_typed_is_what_is_saved(terminal: Callable[..., Terminal], tmp_path: Path):
    """At several speeds; word lists open at the slower ones, they take no Enter."""
    path = tmp_path / "empty.src"
    path.write_text("")
    screen = terminal("empty.src")
    screen.until(lambda: "empty.src" in screen.text and "F5" in screen.text)
    screen.read(0.3)
    for rule, pause in enumerate((0, 0.02, 0.1), 1):
        before = path.read_text()
        for key in f"irule {rule}\rdrux\x7fn\rDYN\r":
            screen.send(key)
            if pause:
                screen.read(pause)
        screen.send(CTRL_S)
        screen.until(lambda before=before: path.read_text() != before)
        assert path.read_text() == f"irule {rule}\ndrun\nDYN\n"
        screen.send(CTRL_A + "\x7f")


def assert_restored(raw: bytes) -> None:
    """Every mode that was switched on is off at the end."""
    for on, off in ((b"\x1b[?1049h", b"\x1b[?1049l"), (b"\x1b[?1003h", b"\x1b[?1003l"), (b"\x1b[?2004h", b"\x1b[?2004l"),
                    (b"\x1b[?25l", b"\x1b[?25h")):  # fmt: skip
        assert raw.rfind(off) > raw.rfind(on) >= 0, off


def test_signals_restore_the_terminal_and_keep_the_work(terminal: Callable[..., Terminal], tmp_path: Path):
    """Each start offers what the signal before has left, and restores it."""
    (tmp_path / "kept.src").write_text("")
    screen = terminal("kept.src")
    screen.until(lambda: "kept.src" in screen.text and "F5" in screen.text)
    screen.read(0.3)
    for number, word in (signal.SIGINT, "precious"), (signal.SIGTERM, "dear"), (signal.SIGHUP, "valued"):
        screen.send("\x1be" + f"{word} = 1\r")  # Alt+E: the editor
        screen.until(lambda screen=screen, word=word: f"{word} = 1" in screen.text)
        screen.child.kill(number)
        screen.child.expect(pexpect.EOF, timeout=PATIENCE_S)
        screen.raw += screen.child.before or b""
        assert_restored(bytes(screen.raw))
        kept = list((tmp_path / "state" / "desire-tui").glob("recovery-*.json"))
        assert len(kept) == 1
        assert f"{word} = 1" in kept[0].read_text()

        screen = terminal("kept.src")
        screen.until(lambda screen=screen: "Unsaved work found" in screen.text)
        screen.answer("r", "Unsaved work found")
        screen.until(lambda screen=screen, word=word: f"{word} = 1" in screen.text)


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGSEGV])
def test_a_kill_loses_at_most_a_checkpoint(
    terminal: Callable[..., Terminal], tmp_path: Path, number: signal.Signals
):
    (tmp_path / "config" / "desire-tui").mkdir(parents=True)
    (tmp_path / "kept.src").write_text("")
    screen = terminal("kept.src", shell=("sh", "-c", '"$@"; read line', "sh"))
    screen.until(lambda: "kept.src" in screen.text and "F5" in screen.text)
    screen.read(0.3)
    screen.send("precious = 1")
    state = tmp_path / "state" / "desire-tui"
    screen.until(lambda: any("precious = 1" in f.read_text() for f in state.glob("recovery-*.json")))
    modes = termios.tcgetattr(screen.child.child_fd)
    os.kill(int(children_of(screen.child.pid)[0]), number)

    # the watchdog restores the terminal and tells where the work is
    screen.until(lambda: b"Desire was killed, or crashed." in screen.raw and screen.raw.endswith(b"\r\n"))
    assert_restored(bytes(screen.raw))
    assert str(next(state.glob("recovery-*.json"))) in screen.raw.decode()
    assert modes != screen.modes_before == termios.tcgetattr(screen.child.child_fd)

    again = terminal()
    again.until(lambda: "Unsaved work found" in again.text)
    again.answer("r", "Unsaved work found")
    again.until(lambda: "precious = 1" in again.text)


def test_a_tiny_terminal_says_so(terminal: Callable[..., Terminal], tmp_path: Path):
    (tmp_path / "a.src").write_text("x = 1\n")
    screen = terminal("a.src", rows=2, columns=15)
    screen.until(lambda: "16 × 3" in " ".join(screen.text.split()))
    screen.resize(5, 20)  # one pane at a time
    screen.until(lambda: "> " in screen.text and "F5" in screen.text)
    screen.resize(24, 80)
    screen.until(lambda: "a.src" in screen.text and "x = 1" in screen.text)


def test_a_browser_is_served_through_pipes(tmp_path: Path):
    """As `desire serve` starts it: no terminal, packets instead; the first thing it hears is that it has no focus."""
    (tmp_path / "served.src").write_text("x = 1\n")
    env = {
        **os.environ, "TEXTUAL_DRIVER": "textual.drivers.web_driver:WebDriver", "COLUMNS": "80", "ROWS": "24",
        "TEXTUAL_COLOR_SYSTEM": "truecolor", "XDG_STATE_HOME": str(tmp_path / "state"), "PYTHONPATH": str(ROOT),
    }  # fmt: skip
    command = [sys.executable, "-m", "desire_tui", "served.src"]
    pipe = subprocess.PIPE
    with subprocess.Popen(command, env=env, cwd=tmp_path, stdin=pipe, stdout=pipe, stderr=pipe) as child:
        assert child.stdin is not None
        assert child.stdout is not None
        seen, end = b"", time.monotonic() + PATIENCE_S
        while (
            b"served.src" not in seen
            and time.monotonic() < end
            and (piece := os.read(child.stdout.fileno(), 65536))
        ):
            seen += piece
        assert b"served.src" in seen
        output, errors = child.communicate(b"D\0\0\0\1" + CTRL_Q.encode(), timeout=PATIENCE_S)
        assert (child.returncode, errors) == (0, b"")
        assert b'{"type": "exit"}' in output
