"""Starts the server as the command line says, with warnings about what is open to others."""

from __future__ import annotations

import asyncio
import os
import socket
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from desire_tui.serve.addresses import announced, is_every_interface, is_loopback
from desire_tui.serve.child_process import Desktop
from desire_tui.serve.server import Server
from desire_tui.serve.visitors import Visitors

if TYPE_CHECKING:
    from collections.abc import Sequence


class CannotServe(Exception):  # noqa: N818 - a sentence for the user
    """Why the server does not start."""


def start(
    files: Sequence[str], host: str, port: int, public_url: str | None, visitors: int,
    *, allow_shell: bool, allow_write: bool,
) -> None:  # fmt: skip
    """Serve until a signal ends it. CannotServe: what was asked for is not possible, or not wise."""
    paths = tuple(Path(file).expanduser().resolve() for file in files)
    folder = served_folder(paths, allow_write=allow_write)
    if is_every_interface(host) and public_url is None:
        raise CannotServe(f"with --host {host} say by --public-url which address visitors use")
    with _listening(host, port) as listening:
        try:
            addresses = announced(host, listening.getsockname()[1], public_url)
        except ValueError:
            raise CannotServe(f"--public-url {public_url} is no http:// or https:// address") from None
        server = Server(Desktop(folder, paths, allow_shell, allow_write), addresses, Visitors(visitors))
        if not is_loopback(str(listening.getsockname()[0])):
            _warn_of_others(host, encrypted=addresses.base.startswith("https:"), allow_shell=allow_shell)
        asyncio.run(server.serve(listening, lambda: _announce(server, folder)))


def served_folder(files: Sequence[Path], *, allow_write: bool) -> Path:
    """Return the one folder that visitors get: the files' own, or the current one."""
    folder = Path(os.path.commonpath([file.parent for file in files])) if files else Path.cwd().resolve()
    if folder in {Path.home().resolve(), Path(folder.anchor)} and not allow_write:
        raise CannotServe(
            f"visitors would get all of {folder}: start in a folder of programs, name files of one, "
            "or give --allow-write"
        )
    return folder


def _listening(host: str, port: int) -> socket.socket:
    try:
        family = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0][0]
        return socket.create_server((host, port), family=family)
    except OSError as error:
        raise CannotServe(f"cannot listen at {host}, port {port}: {error.strerror or error}") from None


def _warn_of_others(host: str, *, encrypted: bool, allow_shell: bool) -> None:
    sentences = [f"warning: other machines can reach {host}; whoever learns an address below can use it."]
    if not encrypted:
        sentences.append("The connection is not encrypted: anyone on the way can read the address.")
    if allow_shell:
        sentences.append("With --allow-shell that is a shell on this machine.")
    sys.stderr.write(" ".join(sentences) + "\n")


def _announce(server: Server, folder: Path) -> None:
    every = len(server.urls) > 1
    print(f"Desire in a browser, with the files in {folder}.")  # noqa: T201 - the command's output
    print("One address for each visitor:" if every else "Open this address; it is for one visitor at a time:")  # noqa: T201
    print(*(f"  {url}" for url in server.urls), "Ctrl-C ends it.", sep="\n", flush=True)  # noqa: T201
