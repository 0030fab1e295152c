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
from codecs import getincrementaldecoder
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pyte
from aiohttp import ClientSession, WSMsgType

if TYPE_CHECKING:
    from collections.abc import Callable

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
    """One websocket; what the desktop shows is in `shown`.

    A task of its own reads: a wait that is broken off in the middle of a read would take a message with it.
    """

    def __init__(self, websocket: ClientWebSocketResponse) -> None:
        self.websocket = websocket
        self.told: list[list[Any]] = []
        """What the page was told beside what it draws."""
        self._screen = pyte.Screen(100, 60)
        self._stream = pyte.Stream(self._screen)
        self._rows = [""] * self._screen.lines
        self._decode = getincrementaldecoder("utf-8")("replace").decode
        self._came = asyncio.Event()
        self._reading = asyncio.create_task(self._read())

    @classmethod
    async def connect(cls, session: ClientSession, served: Served, url: str | None = None) -> Browser:
        return cls(
            await session.ws_connect(
                f"{url or served.url}ws?width=100&height=60", origin=served.origin, max_msg_size=0
            )
        )

    async def until(self, text: str) -> None:
        """Wait until a text stands on the screen."""
        await self._until(lambda: text in self.shown)

    async def until_told(self, kind: str) -> Any:
        """Wait until the page was told something; returns what."""
        await self._until(lambda: any(message[0] == kind for message in self.told))
        at = next(n for n, message in enumerate(self.told) if message[0] == kind)
        return self.told.pop(at)[1]

    async def _until(self, condition: Callable[[], object]) -> None:
        end = time.monotonic() + PATIENCE_S
        while not condition():
            assert not self._reading.done(), f"the connection has ended\n{self.shown}"
            self._came.clear()
            with suppress(TimeoutError):
                await asyncio.wait_for(self._came.wait(), 1.0)
            assert condition() or time.monotonic() < end, self.shown

    async def _read(self) -> None:
        async for message in self.websocket:
            if message.type == WSMsgType.TEXT:
                self.told.append(json.loads(message.data))
            else:
                self._stream.feed(self._decode(message.data))
            self._came.set()
        self._came.set()

    @property
    def rows(self) -> list[str]:
        """What each row shows; only those drawn since the last look are read again."""
        columns = range(self._screen.columns)
        for row in self._screen.dirty:
            cells = self._screen.buffer[row]
            self._rows[row] = "".join([cells[column].data for column in columns])
        self._screen.dirty.clear()
        return self._rows

    @property
    def shown(self) -> str:
        return "\n".join(self.rows)

    @property
    def output(self) -> str:
        """What is shown, without what lies over it for some seconds."""
        return "\n".join(row.partition("▌")[0] for row in self.rows)

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
        """Give a command line and wait for its error between `mark`, a number of its own, and the same behind it."""
        await self._write(mark)
        await self.type(line + ENTER)
        await self._until(lambda: error in self.output.rpartition(str(mark))[2])
        await self._write(-mark)  # all that came of the line stands above

    async def _write(self, number: int) -> None:
        await self.type(f"write {number - 1} + 1{ENTER}")
        await self._until(lambda: re.search(rf"[^0-9-]{number}\b(?! *[-+])", self.output))
