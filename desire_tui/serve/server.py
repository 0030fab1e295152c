"""The web server of `desire serve`."""

from __future__ import annotations

import asyncio
import signal
import sys
import weakref
from typing import TYPE_CHECKING

from aiohttp import WSCloseCode, web

from desire_tui.serve.child_process import complaints, end
from desire_tui.serve.guard import VISITOR, guarded, set_headers
from desire_tui.serve.page import page, static_files
from desire_tui.serve.relay import relay, terminal_size
from desire_tui.serve.visitors import InUse

if TYPE_CHECKING:
    import socket
    from collections.abc import Callable

    from desire_tui.serve.addresses import Addresses
    from desire_tui.serve.child_process import Desktop
    from desire_tui.serve.visitors import Visitor, Visitors

_HEARTBEAT_S = 15.0
"""A browser that vanished without a word is noticed after half of this again."""
_PATIENCE_S = 3.0


class Server:
    """Serves desktops to visitors, each by an address of his own."""

    def __init__(self, desktop: Desktop, addresses: Addresses, visitors: Visitors) -> None:
        self._desktop, self._addresses, self._visitors = desktop, addresses, visitors
        self._static = static_files()
        self._websockets: weakref.WeakSet[web.WebSocketResponse] = weakref.WeakSet()

    @property
    def urls(self) -> list[str]:
        """The visitors' addresses."""
        return [f"{self._addresses.base}/{visitor.token}/" for visitor in self._visitors.all]

    async def serve(self, listening: socket.socket, started: Callable[[], object]) -> None:
        """Serve until a signal ends it; then end all desktops, which keep their work safe."""
        stop = asyncio.Event()
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            asyncio.get_running_loop().add_signal_handler(number, stop.set)
        # no log of requests: their paths hold the tokens
        runner = web.AppRunner(self._application(), access_log=None, shutdown_timeout=15.0)
        await runner.setup()
        try:
            await web.SockSite(runner, listening).start()
            started()
            await stop.wait()
        finally:
            await runner.cleanup()

    def _application(self) -> web.Application:
        app = web.Application(middlewares=[guarded(self._addresses, self._visitors)])
        app.on_response_prepare.append(set_headers(self._addresses))
        app.on_shutdown.append(self._close)
        app.add_routes([
            web.get("/{token}/", self._page),
            web.get("/{token}/static/{name}", self._file),
            web.get("/{token}/ws", self._connect),
        ])  # fmt: skip
        return app

    async def _page(self, request: web.Request) -> web.Response:
        visitor: Visitor = request[VISITOR]
        websocket_url = f"{self._addresses.websocket_base(request.host.lower())}/{visitor.token}/ws"
        return web.Response(
            text=page(websocket_url, request.query.get("fontsize", "")), content_type="text/html"
        )

    async def _file(self, request: web.Request) -> web.Response:
        file = self._static.get(request.match_info["name"])
        if file is None:
            raise web.HTTPNotFound
        return web.Response(body=file.content, content_type=file.kind)

    async def _connect(self, request: web.Request) -> web.StreamResponse:
        visitor: Visitor = request[VISITOR]
        try:
            async with visitor.only_desktop(_PATIENCE_S):
                return await self._session(request)
        except InUse:
            return web.Response(status=409, text="This address is open in another window.\n")

    async def _session(self, request: web.Request) -> web.WebSocketResponse:
        websocket = web.WebSocketResponse(heartbeat=_HEARTBEAT_S)
        await websocket.prepare(request)
        self._websockets.add(websocket)
        process = await self._desktop.start(
            *terminal_size(request.query.get("width"), request.query.get("height"))
        )
        telling = asyncio.create_task(complaints(process))
        try:
            await relay(websocket, process)
        except (TimeoutError, ConnectionError):
            pass  # it hangs, or it has gone
        finally:
            await asyncio.shield(end(process))
            await websocket.close()
            sys.stderr.write(await telling)
        return websocket

    async def _close(self, _: web.Application) -> None:
        for websocket in set(self._websockets):
            await websocket.close(code=WSCloseCode.GOING_AWAY, message=b"The server ends.")
