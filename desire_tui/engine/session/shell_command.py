"""`sh`: a shell command whose output goes to the console, and which Ctrl-C ends."""

from __future__ import annotations

import subprocess
from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.interpreter.host import Interrupted

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

_POLL_SECONDS = 0.05


def run_shell(command: str, folder: Path, write: Callable[[str], object], ending: Callable[[], bool]) -> None:
    """Run a command in `folder`. Interrupted: the user ended it; DesireError 452: its status was not 0."""
    process = subprocess.Popen(  # noqa: S602 - a shell is what the statement is for; permission was asked
        command, shell=True, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    )  # fmt: skip
    while True:
        try:
            output, _ = process.communicate(timeout=_POLL_SECONDS)
            break
        except subprocess.TimeoutExpired:
            if ending():
                process.kill()
    write(output.decode(errors="replace"))
    if ending():
        raise Interrupted
    if process.returncode:
        raise DesireError(
            Diagnostic("shell-failed", facts={"command": command, "status": process.returncode})
        )
