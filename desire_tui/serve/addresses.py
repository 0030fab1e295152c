"""Which addresses the server was announced under: a request's Host and Origin must be one of them.

A web page elsewhere can make a browser send requests here, under its own Origin; and it can give its own name
the address 127.0.0.1 once it is loaded (DNS rebinding), which makes the Host its own.
"""

from __future__ import annotations

import ipaddress
from urllib.parse import urlsplit

from desire_tui.engine.data_classes import dataclass

_DEFAULT_PORTS = {"http": 80, "https": 443}
_LOOPBACK_NAMES = ("127.0.0.1", "localhost", "[::1]")


@dataclass(frozen=True)
class Addresses:
    """What the server was announced as."""

    base: str
    """The URL that visitors are told, without the token; no slash at its end."""
    hosts: frozenset[str]
    """Values of `Host` that are accepted."""
    origins: frozenset[str]
    """Values of `Origin` that are accepted, where there is one."""

    def websocket_base(self, host: str) -> str:
        """Return the URL of websockets for a page that was fetched from `host`, without the token.

        Behind a proxy only the public one is known to the browser.
        """
        if self.base.startswith("https:") or host not in {urlsplit(o).netloc for o in self.origins}:
            return "ws" + self.base.removeprefix("http")
        path = urlsplit(self.base).path
        return f"ws://{host}{path}"


def announced(host: str, port: int, public_url: str | None = None) -> Addresses:
    """Return the addresses of a server at `host`; ValueError: `public_url` is none of http or https."""
    names = _LOOPBACK_NAMES if is_loopback(host) else (_bracketed(host),)
    hosts = {_authority("http", name, port) for name in names}
    if public_url is None:
        base = f"http://{_authority('http', _bracketed(host), port)}"
        return Addresses(base, frozenset(hosts), frozenset(f"http://{name}" for name in hosts))
    parts = urlsplit(public_url)
    if parts.scheme not in _DEFAULT_PORTS or not parts.hostname or parts.query or parts.fragment:
        raise ValueError(public_url)
    public = _authority(parts.scheme, _bracketed(parts.hostname), parts.port or _DEFAULT_PORTS[parts.scheme])
    origin = f"{parts.scheme}://{public}"
    # a proxy hands on the name it was called by, or calls us by our own; the Origin is always the browser's
    return Addresses(origin + parts.path.rstrip("/"), frozenset({public, *hosts}), frozenset({origin}))


def is_loopback(host: str) -> bool:
    """Whether only programs on this machine can reach a server there."""
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host.lower() == "localhost"


def is_every_interface(host: str) -> bool:
    """Whether a server there has no name of its own, but listens at all addresses of the machine."""
    try:
        return ipaddress.ip_address(host).is_unspecified
    except ValueError:
        return not host


def _bracketed(name: str) -> str:
    return f"[{name.lower()}]" if ":" in name else name.lower()


def _authority(scheme: str, name: str, port: int) -> str:
    return name if port == _DEFAULT_PORTS[scheme] else f"{name}:{port}"
