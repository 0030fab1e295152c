"""The process of a visitor's desktop: how it is started, and how it is ended."""

from __future__ import annotations

import asyncio
import contextlib
import hashlib
import os
import signal
import site
import sys
from asyncio.subprocess import PIPE, Process
from pathlib import Path

import desire_tui
from desire_tui.common.paths import state_folder
from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.user_folders import STATE_VARIABLE

DRIVER = "desire_tui.desktop.served_driver:ServedWebDriver"
_ENDING_S = 5.0
"""Seconds for keeping work safe after each of the requests to end, before the next is stronger."""
_TOLD_MOST = 4000


@dataclass(frozen=True)
class Desktop:
    """What the one who serves decides about desktops; a visitor changes none of it."""

    folder: Path
    files: tuple[Path, ...] = ()
    allow_shell: bool = False
    allow_write: bool = False

    @property
    def command(self) -> list[str]:
        """Words of the command: no shell sees them, `-P` keeps modules of the current folder out."""
        flags = {"--allow-shell": self.allow_shell, "--allow-write": self.allow_write}
        granted = [flag for flag, given in flags.items() if given]
        return [sys.executable, "-P", "-m", "desire_tui", "served", *granted, "--", *map(str, self.files)]

    async def start(self, columns: int, rows: int) -> Process:
        """Start one, in a process group of its own: Ctrl-C in the server's terminal is the server's."""
        return await asyncio.create_subprocess_exec(
            *self.command, stdin=PIPE, stdout=PIPE, stderr=PIPE, cwd=self.folder,
            env=self._environment(columns, rows), start_new_session=True,
        )  # fmt: skip

    def _environment(self, columns: int, rows: int) -> dict[str, str]:
        return {
            **os.environ,
            "TEXTUAL_DRIVER": DRIVER,
            "TEXTUAL_FPS": "60",
            "TEXTUAL_COLOR_SYSTEM": "truecolor",
            "TERM_PROGRAM": "textual",
            "COLUMNS": str(columns),
            "ROWS": str(rows),
            "PYTHONPATH": os.pathsep.join(_python_path()),
            STATE_VARIABLE: str(state_folder() / "served" / self._name),
        }

    @property
    def _name(self) -> str:
        """A name for what is kept between sessions: nobody finds there what he may not open."""
        what = f"{self.folder}\0{self.allow_write}"
        return hashlib.sha256(what.encode(errors="surrogateescape")).hexdigest()[:16]


def _python_path() -> list[str]:
    """Return PYTHONPATH without entries that are relative, or empty, which mean the current folder.

    The package's own place belongs to it if it was not installed.
    """
    entries = [
        entry for entry in os.environ.get("PYTHONPATH", "").split(os.pathsep) if Path(entry).is_absolute()
    ]
    place = str(Path(desire_tui.__file__).parents[1])
    installed = {*site.getsitepackages(), site.getusersitepackages()}
    return entries if place in entries or place in installed else [*entries, place]


async def complaints(process: Process) -> str:
    """Return the last of what a process says on standard error, without control characters."""
    assert process.stderr is not None
    last = b""
    while piece := await process.stderr.read(_TOLD_MOST):
        last = (last + piece)[-_TOLD_MOST:]
    return "".join(c if c == "\n" or c.isprintable() else "·" for c in last.decode(errors="replace"))


async def end(process: Process) -> None:
    """End a desktop whose visitor has left: asked, told, killed, with all that it started."""
    assert process.stdin is not None
    assert process.stdout is not None
    process.stdin.close()  # the driver takes it for a lost connection: work is kept safe
    draining = asyncio.create_task(_drain(process.stdout))  # what waits to write cannot end
    for number in (signal.SIGTERM, signal.SIGKILL):
        with contextlib.suppress(TimeoutError):
            await asyncio.wait_for(process.wait(), _ENDING_S)
            break
        _signal_group(process, number)
    _signal_group(process, signal.SIGKILL)  # what it started and left behind
    await process.wait()
    draining.cancel()


async def _drain(output: asyncio.StreamReader) -> None:
    while await output.read(2**16):
        pass


def _signal_group(process: Process, number: signal.Signals) -> None:
    with contextlib.suppress(ProcessLookupError, PermissionError):
        os.killpg(process.pid, number)
