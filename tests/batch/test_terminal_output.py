"""What `desire run` and `desire check` send to a terminal; files and pipes get every byte."""

from __future__ import annotations

import os
import pty
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
TITLE, CLIPBOARD, SEQUENCE, BIDI = "\x1b]0;PWNED\x07", "\x1b]52;c;UFdORUQ=\x07", "\x9b5nPWNED", "\u202ePWNED"
EVIL = TITLE + CLIPBOARD + SEQUENCE + BIDI
OUR_OWN = re.compile(r"\x1b\[(K|0m|[34]8;2;\d+;\d+;\d+m)|[\r\n]")
"""The progress line and the colours of `--plot`."""
PROGRAM = f"""\
-- comment {EVIL}
TMAX = 1 | DT = 0.1 | NN = 11 | x = 1
write '{EVIL}'
write $27; ']0;PWNED'; $7
note '{EVIL}'
sh printf '\\033]0;PWNED\\007'
input a
drun
write 'all done'
DYNAMIC
d/dt x = -x
dispt x
"""
WRONG = f"x = 1\nwrite misspelt + {EVIL}\n"


def on_terminal(*args: str, cwd: Path, answer: str = "3") -> str:
    """Return all that a command sends to its terminal."""
    ours, theirs = pty.openpty()
    process = subprocess.Popen(
        [sys.executable, "-m", "desire_tui", *args], cwd=cwd, stdin=subprocess.PIPE, stdout=theirs, stderr=theirs,
        env={**os.environ, "PYTHONPATH": str(ROOT), "PYTHONUTF8": "1"},
    )  # fmt: skip
    os.close(theirs)
    assert process.stdin is not None
    process.stdin.write((f"{answer}{EVIL}\n3\n").encode())
    process.stdin.close()
    output = b""
    try:
        while piece := os.read(ours, 65536):
            output += piece
    except OSError:  # the other end is closed
        pass
    process.wait(300)
    os.close(ours)
    return output.decode()


def commands_in(output: str) -> str:
    """Return what a terminal would not show as it is, but for what is ours."""
    rest = OUR_OWN.sub("", output)
    return "".join(c for c in rest if not c.isprintable() and c != "\t")


@pytest.mark.parametrize("name", ["p.src", f"{EVIL.replace('/', '')}.src"])
@pytest.mark.parametrize("statement", ["run", "check"])
def test_no_program_reaches_the_terminal_with_a_command(name, statement, tmp_path):
    for text in (PROGRAM, WRONG):
        (tmp_path / name).write_text(text)
        options = () if statement == "check" else ("--plot", "--allow-shell")
        output = on_terminal(statement, *options, name, cwd=tmp_path)
        assert commands_in(output) == ""
        if text == WRONG:
            assert "PWNED" in output
        elif statement == "run":
            assert "all done" in output
            assert output.count("PWNED") > 6


def test_results_on_a_terminal(tmp_path):
    (tmp_path / "p.src").write_text(f"write '{EVIL}'\n")
    for name in ("json", "csv"):
        output = on_terminal("run", f"--{name}", "-", "p.src", cwd=tmp_path)
        assert commands_in(output) == ""


def test_write_of_a_character_by_its_code(tmp_path):
    (tmp_path / "p.src").write_text("write $27; '[1m'; $7; $8238\nwrite 'ready'\n")
    exact = "\x1b[1m\x07\u202e\nready\n"
    piped = subprocess.run(
        [sys.executable, "-m", "desire_tui", "run", "p.src"], cwd=tmp_path, capture_output=True, check=True,
        env={**os.environ, "PYTHONPATH": str(ROOT), "PYTHONUTF8": "1"},
    )  # fmt: skip
    assert piped.stdout.decode() == exact
    assert on_terminal("run", "p.src", cwd=tmp_path).replace("\r\n", "\n") == "␛[1m␇�\nready\n"
    assert on_terminal("run", "--raw", "p.src", cwd=tmp_path).replace("\r\n", "\n") == exact
