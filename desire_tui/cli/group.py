"""`desire` itself: files for the desktop, or a command."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import click

from desire_tui.engine.visible_text import visible

if TYPE_CHECKING:
    from collections.abc import Iterator

    from click.shell_completion import CompletionItem

PROGRAMS = click.Path(readable=False, allow_dash=True)
"""Names of programs: a shell completes them; whether they can be read is found out, and told, later."""


class FilesOrCommand(click.Group):
    """A first word that is no command is a file for the desktop."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Read the words after `desire`; put the desktop's own command before names of files."""
        first = next((a for a in args if not a.startswith("-")), None)
        if first is not None and first not in self.commands:
            args = ["ide", *args]
        return super().parse_args(ctx, args)

    def shell_complete(self, ctx: click.Context, incomplete: str) -> list[CompletionItem]:
        """Return the commands that begin so; the shell's own list of files where none does."""
        found = super().shell_complete(ctx, incomplete)
        return found or PROGRAMS.shell_complete(ctx, click.Argument(["files"]), incomplete)

    def make_context(self, *args: Any, **options: Any) -> click.Context:
        """Read the words; what a message repeats of them, a terminal does not obey."""
        with _visible_messages():
            return super().make_context(*args, **options)

    def invoke(self, ctx: click.Context) -> Any:
        """Carry a command out, with such messages too."""
        with _visible_messages():
            return super().invoke(ctx)


@contextmanager
def _visible_messages() -> Iterator[None]:
    try:
        yield
    except click.UsageError as error:
        sentence = error.format_message()
        if (shown := visible(sentence)) == sentence:
            raise
        raise click.UsageError(shown, error.ctx) from None


def _print_version(context: click.Context, _: click.Parameter, wanted: bool) -> None:
    if not wanted or context.resilient_parsing:
        return
    from desire_tui.versions import versions

    click.echo("\n".join(versions()))
    context.exit()


@click.group(cls=FilesOrCommand, invoke_without_command=True)
@click.option("--version", is_flag=True, expose_value=False, is_eager=True, callback=_print_version,
              help="Show the version, and those of what it stands on.")  # fmt: skip
@click.pass_context
def main(context: click.Context) -> None:
    """Desire: interactive dynamic-system simulation in the terminal.

    `desire [FILE…]` opens the desktop.
    """
    if context.invoked_subcommand is None:
        open_the_desktop(())


@click.command(name="ide", hidden=True)
@click.argument("files", nargs=-1, type=PROGRAMS)
def ide(files: tuple[str, ...]) -> None:
    """Open the desktop."""
    open_the_desktop(files)


def open_the_desktop(files: tuple[str, ...]) -> None:
    """Open the desktop, which ends the process. UsageError: there is no terminal."""
    from desire_tui.launch import is_possible, open_desktop

    if not is_possible():
        raise click.UsageError("the desktop needs a terminal; `desire run FILE` works without one")
    open_desktop(files)
