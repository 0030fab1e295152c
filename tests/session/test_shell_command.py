"""`sh`: what it prints comes as it is printed and up to a limit; the user ends it with all it started."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from typing import TYPE_CHECKING

import pytest

from desire_tui.batch.headless_listener import HeadlessListener
from desire_tui.batch.runner import Runner, RunOptions
from desire_tui.engine.interpreter.host import Interrupted
from desire_tui.engine.session import shell_command
from desire_tui.engine.session.shell_command import run_shell
from desire_tui.engine.source import Source

if TYPE_CHECKING:
    from pathlib import Path


class EndedOnce:
    """A user who ends the command once it has written a file."""

    def __init__(self, path: Path) -> None:
        self._path = path

    def __call__(self) -> bool:
        return self._path.exists() and self._path.read_text().endswith("\n")


def printed(command, folder, ending=lambda: False):
    """Return what a command prints, and its status."""
    parts = []
    status = run_shell(command, folder, parts.append, ending)
    return "".join(parts), status


def is_alive(pid: int) -> bool:
    """Whether a process still works (and is no zombie)."""
    found = subprocess.run(["ps", "-o", "stat=", "-p", str(pid)], capture_output=True, text=True, check=False)
    return bool(found.stdout.strip()) and not found.stdout.startswith("Z")


def dies(pid: int) -> bool:
    """Whether a process is gone soon, however busy the machine is."""
    deadline = time.monotonic() + 200
    while is_alive(pid) and time.monotonic() < deadline:
        time.sleep(0.02)
    return not is_alive(pid)


def test_output_and_status(tmp_path):
    assert printed("printf 'a\\nb'; printf c >&2", tmp_path) == ("a\nbc", 0)
    assert printed("echo no; exit 3", tmp_path) == ("no\n", 3)
    assert printed("pwd -P", tmp_path) == (f"{tmp_path.resolve()}\n", 0)


def test_output_comes_as_it_is_printed(tmp_path):
    came = []

    def hear(text):
        came.append(text)
        (tmp_path / "heard").touch()

    run_shell(
        "echo early; while [ ! -e heard ]; do sleep 0.02; done; echo late", tmp_path, hear, lambda: False
    )
    assert came == ["early\n", "late\n"]


def test_letters_cut_between_two_pieces_stay_whole(tmp_path):
    assert printed("printf '\\303'; sleep 0.2; printf '\\251'", tmp_path) == ("é", 0)


@pytest.mark.parametrize(
    "command",
    [
        "echo $$ > pid; exec sleep 300",
        "sleep 300 & echo $! > pid; wait",
        "trap '' TERM; echo $$ > pid; while true; do sleep 0.1; done",
        "(trap '' TERM; sleep 300; sleep 300) & echo $! > pid; wait",
        "echo $$ > pid; exec >&- 2>&-; sleep 300",
        "echo $$ > pid; exec yes",
    ],
)
def test_the_user_ends_it_with_all_it_started(tmp_path, command):
    began = time.monotonic()
    with pytest.raises(Interrupted):
        run_shell(command, tmp_path, len, EndedOnce(tmp_path / "pid"))
    assert time.monotonic() - began < 200
    assert dies(int((tmp_path / "pid").read_text()))


def test_a_command_that_was_asked_to_end_can_clear_up(tmp_path):
    with pytest.raises(Interrupted):
        run_shell(
            "trap 'echo > cleared; exit' TERM; echo > set; while true; do sleep 0.05; done",
            tmp_path, len, EndedOnce(tmp_path / "set"),
        )  # fmt: skip
    assert (tmp_path / "cleared").exists()


def test_what_runs_in_the_background_is_not_waited_for(tmp_path):
    began = time.monotonic()
    text, status = printed("echo on; (trap '' PIPE; sleep 300) & yes & echo $! > pid", tmp_path)
    assert time.monotonic() - began < 200
    assert text.startswith("on\n")
    assert status == 0
    assert dies(int((tmp_path / "pid").read_text())), "nobody reads what it writes"


def test_output_has_a_limit_and_does_not_stop_the_command(tmp_path, monkeypatch):
    monkeypatch.setattr(shell_command, "OUTPUT_BYTES_MAX", 1000)
    text, status = printed("head -c 50000000 /dev/zero | tr '\\0' x; echo > done", tmp_path)
    assert status == 0
    assert (tmp_path / "done").exists()
    assert text == "x" * 1000 + "\n… and 49999000 bytes more that are not shown\n"


def test_the_time_limit_of_a_headless_run_ends_it(tmp_path):
    listener = HeadlessListener(len, iter(()), len)
    options = RunOptions(timeout=2, folder=tmp_path, allow_shell=True)
    runner = Runner(
        Source("sh (trap '' TERM; sleep 300; sleep 300) & echo $! > pid; wait\n", "t.src"), options, listener
    )
    began = time.monotonic()
    runner.run()
    assert time.monotonic() - began < 200
    assert runner.status == "limit"
    assert not runner.abandoned
    assert dies(int((tmp_path / "pid").read_text()))


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_to_a_headless_run_ends_it(tmp_path, number):
    (tmp_path / "t.src").write_text("sh echo $$ > pid; echo on; exec sleep 300\n")
    command = [sys.executable, "-m", "desire_tui", "run", "--allow-shell", "t.src"]
    process = subprocess.Popen(
        command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, stdin=subprocess.DEVNULL,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
    )  # fmt: skip
    killer = threading.Timer(200, process.kill)
    killer.start()
    assert process.stdout is not None
    assert process.stdout.readline() == b"on\n"
    process.send_signal(number)
    status = process.wait()
    killer.cancel()
    process.stdout.close()
    assert status == (3 if number == signal.SIGINT else -number)
    assert dies(int((tmp_path / "pid").read_text()))
