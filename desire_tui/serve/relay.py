"""Between a websocket of the terminal in the browser and the pipes of a desktop's process.

The browser sends JSON: `["stdin", text]`, `["resize", {"width": …, "height": …}]`, `["focus"]`, `["blur"]`,
`["ping", text]`. It is told `["unsaved", true or false]` and `["file", {"name": …, "base64": …}]`, which the
visitor gets as a download. Packets in the pipes are a letter, the length in four bytes, the content: `D` for
what a terminal would send or show, `M` for JSON (Textual's web driver).
"""

from __future__ import annotations

import asyncio
import json
from pathlib import PurePath
from typing import TYPE_CHECKING, Any

from aiohttp import WSMsgType

if TYPE_CHECKING:
    from asyncio.subprocess import Process

    from aiohttp.web import WebSocketResponse

_READY = b"__GANGLION__\n"
_LINES_BEFORE = 10
_HUNG_S = 30.0
"""A desktop that takes no input for so long has stopped working."""
_COLUMNS, _ROWS = range(2, 1001), range(2, 501)


def terminal_size(width: object, height: object) -> tuple[int, int]:
    """Return the size a browser asks for, kept to what can be drawn; 80×24 for what is no number."""
    return _within(width, _COLUMNS, 80), _within(height, _ROWS, 24)


def _within(wanted: object, bounds: range, default: int) -> int:
    try:
        number = int(str(wanted)[:9])
    except ValueError:
        return default
    return min(max(number, bounds.start), bounds.stop - 1)


async def relay(websocket: WebSocketResponse, process: Process) -> None:
    """Carry packets both ways until either side ends."""
    tasks = [
        asyncio.create_task(_to_desktop(websocket, process)),
        asyncio.create_task(_to_browser(websocket, process)),
    ]
    try:
        done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        for task in done:
            task.result()
    finally:
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)


async def _to_desktop(websocket: WebSocketResponse, process: Process) -> None:
    assert process.stdin is not None
    async for message in websocket:
        if message.type != WSMsgType.TEXT:
            continue
        kind, content = _message(message.data)
        if kind == "ping":
            await websocket.send_json(["pong", str(content)[:40]])
        elif (packet := _packet(kind, content)) is not None:
            process.stdin.write(packet)
            await asyncio.wait_for(process.stdin.drain(), _HUNG_S)


def _message(text: str) -> tuple[object, object]:
    try:
        message = json.loads(text)
    except (ValueError, RecursionError):
        return None, None
    return (*message, None, None)[:2] if isinstance(message, list) else (None, None)


def _packet(kind: object, content: object) -> bytes | None:
    """Return what the desktop gets; None for messages that are none."""
    if kind == "stdin" and isinstance(content, str):
        return _framed(b"D", content.encode(errors="replace"))
    if kind == "resize" and isinstance(content, dict):
        columns, rows = terminal_size(content.get("width"), content.get("height"))
        return _framed(b"M", json.dumps({"type": "resize", "width": columns, "height": rows}).encode())
    if kind in ("focus", "blur"):
        return _framed(b"M", json.dumps({"type": kind}).encode())
    return None


def _framed(letter: bytes, content: bytes) -> bytes:
    return letter + len(content).to_bytes(4, "big") + content


async def _to_browser(websocket: WebSocketResponse, process: Process) -> None:
    assert process.stdout is not None
    try:
        for _ in range(_LINES_BEFORE):
            if await process.stdout.readline() == _READY:
                break
        else:
            return
        while True:
            head = await process.stdout.readexactly(5)
            content = await process.stdout.readexactly(int.from_bytes(head[1:], "big"))
            if head[:1] == b"D":
                await websocket.send_bytes(content)
            elif head[:1] == b"M" and (message := _told(content)) is not None:
                await websocket.send_json(message)
    except (asyncio.IncompleteReadError, ConnectionError):
        return  # one of the two has gone


def _told(content: bytes) -> list[Any] | None:
    """Return what the page is told of what a desktop says; None if that is not for it.

    A page of the help leads to nothing but a page of the web, in a window of its own.
    """
    meta = json.loads(content)
    match meta.get("type"):
        case "open_url" if str(url := meta.get("url")).startswith(("https://", "http://")):
            return ["open_url", {"url": url, "new_tab": True}]
        case "unsaved":
            return ["unsaved", bool(meta.get("unsaved"))]
        case "file":
            return ["file", {"name": PurePath(str(meta.get("name"))).name, "base64": str(meta.get("base64"))}]
    return None
