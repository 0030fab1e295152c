"""`desire serve`: the desktop in a browser."""

from __future__ import annotations

from importlib.util import find_spec
from typing import Any

import click

from desire_tui.cli.group import PROGRAMS

_ALLOWANCES = (
    click.option("--allow-shell", is_flag=True, help="Let visitors and programs run shell commands."),
    click.option(
        "--allow-write", is_flag=True, help="Let visitors and programs use files outside the folder."
    ),
)
_LIBRARIES = ("aiohttp", "textual_serve")
"""What the extra `serve` brings."""


@click.command()
@click.argument("files", nargs=-1, type=PROGRAMS)
@click.option("--host", default="127.0.0.1", show_default=True, help="Where to listen.")
@click.option(
    "--port", default=8000, show_default=True, type=click.IntRange(0, 65535), help="0: any free one."
)
@click.option(
    "--public-url", metavar="URL", help="The address that visitors use, of a proxy before this server."
)
@click.option("--visitors", default=1, show_default=True, type=click.IntRange(1, 100),
              help="How many may use it at once; each gets an address.")  # fmt: skip
@_ALLOWANCES[0]
@_ALLOWANCES[1]
def serve(files: tuple[str, ...], host: str, port: int, public_url: str | None, **options: Any) -> None:
    """Put the desktop into a browser.

    Prints a secret address. Visitors get the folder of FILES, or the current one, and nothing outside; shell
    commands are refused. Needs pip install 'desire-tui[serve]'.
    """
    missing = [library for library in _LIBRARIES if find_spec(library) is None]
    if missing:
        names = " and ".join(name.replace("_", "-") for name in missing)
        raise click.UsageError(f"desire serve needs {names}: pip install 'desire-tui[serve]'")
    from desire_tui.serve.start import CannotServe, start

    try:
        start(files, host, port, public_url, **options)
    except CannotServe as reason:
        raise click.UsageError(str(reason)) from None


@click.command(hidden=True)
@click.argument("files", nargs=-1, type=PROGRAMS)
@_ALLOWANCES[0]
@_ALLOWANCES[1]
def served(files: tuple[str, ...], *, allow_shell: bool, allow_write: bool) -> None:
    """Be the desktop of a visitor: `serve` starts it."""
    from desire_tui.launch import is_served, open_desktop

    if not is_served():
        raise click.UsageError("`desire serve` starts this")
    open_desktop(files, allow_shell=allow_shell, allow_write=allow_write)
