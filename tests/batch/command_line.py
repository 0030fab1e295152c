"""`desire …` within the process of the tests; and as a process of its own, where that is what a test is about."""

from __future__ import annotations

import os
import subprocess
import sys
from contextlib import chdir
from pathlib import Path
from typing import Any

from click.testing import CliRunner

from desire_tui.cli import main

ROOT = Path(__file__).resolve().parents[2]


def desire(*args: object, cwd: Path | None = None, text_in: str = "") -> tuple[int, str, str]:
    """Run the command without the half second that a process takes to start; returns status, stdout, stderr."""
    with chdir(cwd or Path.cwd()):
        done = CliRunner().invoke(main, [str(word) for word in args], input=text_in)
    if done.exception is not None and not isinstance(done.exception, SystemExit):
        raise done.exception
    assert "Traceback" not in done.stderr, done.stderr
    return done.exit_code, done.stdout, done.stderr


def desire_process(*args: object, text_in: str = "", **options: Any) -> tuple[int, str, str]:
    """Run the command as a user does; returns status, stdout, stderr."""
    done = subprocess.run(
        [sys.executable, "-m", "desire_tui", *map(str, args)], input=text_in, capture_output=True, text=True,
        timeout=300, check=False, env={**os.environ, "PYTHONPATH": str(ROOT)}, **options,
    )  # fmt: skip
    assert "Traceback" not in done.stderr, done.stderr
    return done.returncode, done.stdout, done.stderr
