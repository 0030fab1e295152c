"""The command `desire.run`: runs a program as it stands in the editor, and tells what became of it."""

from __future__ import annotations

import asyncio
import json
import os
import signal
import sys
import tempfile
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lsprotocol import types

if TYPE_CHECKING:
    from desire_tui.lsp.documents import Document, Snapshot

RUN = "desire.run"
_ENDING_SECONDS = 5.0
_WORDS = {"done": "done", "stopped": "stopped at STOP", "failed": "failed", "limit": "ended"}


class Runs:
    """Runs programs, one process each; their pictures live as long as the server."""

    def __init__(self) -> None:
        self._folder: tempfile.TemporaryDirectory[str] | None = None
        self._running: dict[int, asyncio.subprocess.Process] = {}

    async def run(self, document: Document) -> dict[str, Any]:
        """Run a document's program; an earlier run of it is ended. Returns what `run_worker.run` does."""
        await self.end(document.number)
        source = document.snapshot.source
        request = {
            "text": source.text, "name": source.name,
            "path": str(source.path) if source.path is not None else None,
            "picture": str(self._picture(document)),
        }  # fmt: skip
        process = await asyncio.create_subprocess_exec(
            sys.executable, "-m", "desire_tui.lsp.run_worker", stdin=asyncio.subprocess.PIPE,
            stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.PIPE,
            env={**os.environ, "PYTHONPATH": _own_path(), "PYTHONSAFEPATH": "1"},
        )  # fmt: skip
        self._running[document.number] = process
        try:
            out, errors = await process.communicate(json.dumps(request).encode())
        except asyncio.CancelledError:
            await self.end(document.number)
            raise
        finally:
            if self._running.get(document.number) is process:
                del self._running[document.number]
        try:
            answer: dict[str, Any] = json.loads(out)
        except ValueError:
            tail = errors.decode(errors="replace").strip().splitlines()[-1:]
            status = process.returncode or 0
            reason = tail[0] if tail else f"its process ended with status {status}"
            return {
                "status": "failed", "reason": reason, "problems": [], "console": "", "runs": [],
                "pictures": [], "values": {},
            }  # fmt: skip
        return answer

    async def end(self, number: int) -> None:
        """End a document's run, if there is one: asked first, as by Ctrl-C."""
        process = self._running.pop(number, None)
        if process is None:
            return
        for ask in (signal.SIGINT, signal.SIGKILL):
            with suppress(ProcessLookupError):
                process.send_signal(ask)
            with suppress(TimeoutError):
                await asyncio.wait_for(process.wait(), _ENDING_SECONDS)
                return

    def close(self) -> None:
        """End what still runs, and remove the pictures."""
        for process in self._running.values():
            with suppress(ProcessLookupError):
                process.kill()
        if self._folder is not None:
            self._folder.cleanup()

    def _picture(self, document: Document) -> Path:
        """Return where a document's picture goes; those of the run before are removed."""
        if self._folder is None:
            self._folder = tempfile.TemporaryDirectory(prefix="desire-lsp-")
        stem = document.path.stem if document.path is not None else "program"
        folder = Path(self._folder.name, str(document.number))
        folder.mkdir(exist_ok=True)
        for old in folder.iterdir():
            old.unlink()
        return folder / f"{stem}.png"


def _own_path() -> str:
    """Return where this package was imported from, for a process that must find the same."""
    own = str(Path(__file__).parents[2])
    before = os.environ.get("PYTHONPATH", "")
    return os.pathsep.join([own, before]) if before else own


def lenses(snapshot: Snapshot, uri: str) -> list[types.CodeLens]:
    """Return "Run" above the program's first statement."""
    statements = snapshot.names.statements
    if not statements:
        return []
    row = snapshot.source.position(statements[0].at).row - 1
    where = types.Range(types.Position(row, 0), types.Position(row, 0))
    return [types.CodeLens(where, types.Command("▶ Run", RUN, arguments=[uri]))]


def report(name: str, answer: dict[str, Any]) -> tuple[types.MessageType, str]:
    """Return what became of a run, in one sentence."""
    errors = [problem for problem in answer["problems"] if problem["severity"] == "error"]
    runs = answer["runs"]
    parts = [f"{Path(name).name}: {_WORDS[answer['status']]}"]
    if runs:
        parts.append(f"{len(runs)} run{'s' * (len(runs) != 1)}")
    if errors:
        place = f"line {errors[0]['line']}: " if errors[0]["line"] else ""
        parts.append(f"{place}error {errors[0]['code']}: {errors[0]['message']}")
    elif answer.get("reason"):
        parts.append(answer["reason"])
    if answer["pictures"]:
        parts.append(f"graph in {answer['pictures'][-1]}")
    failed = errors or answer["status"] == "failed"
    return types.MessageType.Error if failed else types.MessageType.Info, ", ".join(parts)
