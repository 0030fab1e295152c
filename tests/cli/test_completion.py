"""Shells complete commands, options and file names by what `desire completion` prints."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys

import pytest

from tests.batch.command_line import ROOT, desire

SCRIPT = """eval "$(desire completion bash)"
compopt() { echo "$2"; }
COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1))
_desire_completion desire
echo "${COMPREPLY[*]}"
"""


@pytest.fixture(scope="module")
def bash(tmp_path_factory):
    """Return a function that completes words in bash, `desire` being these sources."""
    if shutil.which("bash") is None:
        pytest.skip("no bash here")
    folder = tmp_path_factory.mktemp("bin")
    command = folder / "desire"
    command.write_text(f'#!/bin/sh\nexec {sys.executable} -m desire_tui "$@"\n')
    command.chmod(0o755)
    (folder / "script").write_text(SCRIPT)
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "PATH": f"{folder}:{os.environ['PATH']}"}

    def complete(*words):
        done = subprocess.run(
            ["bash", str(folder / "script"), "desire", *words], capture_output=True, text=True, check=True,
            env=environment,
        )  # fmt: skip
        assert done.stderr == ""
        return done.stdout.split()

    return complete


@pytest.mark.parametrize(
    ("words", "completed"),
    [
        (("ru",), ["run"]),
        (("pro",), ["default"]),  # the shell's own list of files
        (("run", "pro"), ["default"]),
        (("run", "a.src", "--csv", "x"), ["default"]),
        (("run", "--sty"), ["--style"]),
        (("run", "--style", "s"), ["screen"]),
        (("examples", "--copy", "x"), ["dirnames"]),
    ],
)
def test_bash(bash, words, completed):
    assert bash(*words) == completed


@pytest.mark.parametrize(
    ("shell", "word"), [("zsh", "#compdef desire"), ("fish", "complete --no-files --command desire")]
)
def test_other_shells(shell, word):
    status, out, _ = desire("completion", shell)
    assert status == 0
    assert word in out
    assert "_DESIRE_COMPLETE" in out
