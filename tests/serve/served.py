"""A server as a user starts it, in a process of its own; and a browser's side of the websocket."""

from __future__ import annotations

import asyncio
import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pyte
from aiohttp import ClientSession, WSMsgType

if TYPE_CHECKING:
    from aiohttp import ClientWebSocketResponse

ROOT = Path(__file__).parents[2]
PATIENCE_S = 60.0
ENTER = "\r"


class Served:
    """A running `desire serve`."""

    def __init__(self, folder: Path, *words: str, python: tuple[str, ...] = ("-P",)) -> None:
        (folder / "home").mkdir(exist_ok=True)
        env = {
            **os.environ, "PYTHONPATH": str(ROOT), "HOME": str(folder / "home"),
            "XDG_STATE_HOME": str(folder / "state"), "XDG_CONFIG_HOME": str(folder / "config"),
        }  # fmt: skip
        self.folder = folder / "models"
        self.folder.mkdir(exist_ok=True)
        command = [sys.executable, *python, "-m", "desire_tui", "serve", "--port", "0", *words]
        self.errors = (folder / "errors.txt").open("w+")
        self.process = subprocess.Popen(
            command, env=env, cwd=self.folder, stdout=subprocess.PIPE, stderr=self.errors, text=True
        )
        self.urls: list[str] = []
        assert self.process.stdout is not None
        while line := self.process.stdout.readline():
            self.urls += re.findall(r"http\S*", line)
            if "Ctrl-C" in line:
                break

    @property
    def url(self) -> str:
        return self.urls[0]

    @property
    def origin(self) -> str:
        return "/".join(self.url.split("/")[:3])

    @property
    def complaints(self) -> str:
        return Path(self.errors.name).read_text()

    def end(self) -> int:
        self.process.send_signal(signal.SIGTERM)
        status = self.process.wait(PATIENCE_S)
        self.errors.close()
        assert self.process.stdout is not None
        self.process.stdout.close()
        return status


class Browser:
    """One websocket; what the desktop shows is in `shown`."""

    def __init__(self, websocket: ClientWebSocketResponse) -> None:
        self.websocket = websocket
        self.told: list[list[Any]] = []
        """What the page was told beside what it draws."""
        self._screen = pyte.Screen(100, 60)
        self._stream = pyte.Stream(self._screen)

    @classmethod
    async def connect(cls, session: ClientSession, served: Served, url: str | None = None) -> Browser:
        return cls(
            await session.ws_connect(
                f"{url or served.url}ws?width=100&height=60", origin=served.origin, max_msg_size=0
            )
        )

    async def until(self, text: str) -> None:
        """Wait until a text stands on the screen."""
        end = time.monotonic() + PATIENCE_S
        while text not in self.shown:
            await self._receive(end)

    async def until_told(self, kind: str) -> Any:
        """Wait until the page was told something; returns what."""
        end = time.monotonic() + PATIENCE_S
        while not any(message[0] == kind for message in self.told):
            await self._receive(end)
        at = next(n for n, message in enumerate(self.told) if message[0] == kind)
        return self.told.pop(at)[1]

    async def _until_below(self, mark: str, text: str) -> None:
        """Wait until a text stands below another, and no part of the screen is still to come."""
        end = time.monotonic() + PATIENCE_S
        while True:
            if text in self.shown.rpartition(mark)[2]:
                try:
                    await self._receive(time.monotonic() + 0.1)
                except TimeoutError:
                    return
            else:
                await self._receive(end)

    async def _receive(self, end: float) -> None:
        assert time.monotonic() < end, self.shown
        message = await asyncio.wait_for(self.websocket.receive(), max(0.1, end - time.monotonic()))
        assert message.type in (WSMsgType.BINARY, WSMsgType.TEXT), f"{message}\n{self.shown}"
        if message.type == WSMsgType.TEXT:
            self.told.append(json.loads(message.data))
        else:
            self._stream.feed(message.data.decode(errors="replace"))

    @property
    def shown(self) -> str:
        return "\n".join(self._screen.display)

    async def type(self, text: str) -> None:
        for letter in text:
            await self.websocket.send_json(["stdin", letter])

    async def press(self, key: str) -> None:
        """Send a key's escape sequence, in one piece as a browser does."""
        await self.websocket.send_json(["stdin", key])

    async def command(self, line: str) -> None:
        self._screen.reset()
        await self.type(line + ENTER)

    async def fails(self, line: str, error: str, *, mark: int) -> None:
        """Give a command line and wait for its error: the one below `mark`, a number of its own."""
        await self.type(f"write {mark - 1} + 1{ENTER}")
        await self.until(str(mark))
        await self.type(line + ENTER)
        await self._until_below(str(mark), error)
