"""What every request must pass, whatever it asks for, and what every answer says to the browser."""

from __future__ import annotations

from typing import TYPE_CHECKING

from aiohttp import hdrs, web

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, MutableMapping

    from aiohttp.typedefs import Middleware

    from desire_tui.serve.addresses import Addresses
    from desire_tui.serve.visitors import Visitors

    Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]

VISITOR = "visitor"
"""Key of a request's visitor."""
_HEADERS = {
    "Cache-Control": "no-store",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
}
_CONTENT_POLICY = (
    # 'unsafe-inline': xterm.js makes style elements; no page holds what a visitor or a program wrote
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; font-src 'self'; "
    "img-src 'self' data:; connect-src {websocket}; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'"
)


def guarded(addresses: Addresses, visitors: Visitors) -> Middleware:
    """Return what stands before all handlers: they get requests of visitors, each with its visitor."""

    @web.middleware
    async def guard(request: web.Request, handler: Handler) -> web.StreamResponse:
        if (refusal := _refusal(request, addresses, visitors)) is not None:
            return refusal
        return await handler(request)

    return guard


def _refusal(request: web.Request, addresses: Addresses, visitors: Visitors) -> web.Response | None:
    hosts = request.headers.getall(hdrs.HOST, [])
    if len(hosts) != 1 or hosts[0].lower() not in addresses.hosts:
        return _refused(421, "This server was not announced under that name.")
    origins = request.headers.getall(hdrs.ORIGIN, [])
    if any(origin.lower() not in addresses.origins for origin in origins):
        return _refused(403, "A page from elsewhere may ask for nothing here.")
    if not origins and hdrs.UPGRADE in request.headers:
        return _refused(403, "A websocket is for a page of this server.")
    visitor = visitors.with_token(request.path.split("/")[1])
    if visitor is None:
        return _refused(403, "Open the whole address that `desire serve` printed: it holds a token.")
    request[VISITOR] = visitor
    return None


def _refused(status: int, sentence: str) -> web.Response:
    return web.Response(status=status, text=sentence + "\n")


def set_headers(addresses: Addresses) -> Callable[[web.Request, web.StreamResponse], Awaitable[None]]:
    """Return a signal handler that adds to every answer what a browser is to allow."""

    async def prepare(request: web.Request, response: web.StreamResponse) -> None:
        headers: MutableMapping[str, str] = response.headers
        headers.update(_HEADERS)
        # an unknown Host gets no say in what its page may connect to
        known = request.host.lower() in addresses.hosts
        websocket = addresses.websocket_base(request.host.lower()) if known else "'none'"
        headers["Content-Security-Policy"] = _CONTENT_POLICY.format(websocket=websocket)
        headers.pop(hdrs.SERVER, None)

    return prepare
