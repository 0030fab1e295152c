"""`desire help`, `desire examples`, `desire config`: what comes with the program, in the shell."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from desire_tui.batch.ending import guarded


@click.command()
def config() -> None:
    """Print where the configuration file is, and what it may hold."""
    from desire_tui.common.config import defaults_text
    from desire_tui.common.paths import config_file

    click.echo(f"# {config_file()}")
    click.echo(defaults_text(), nl=False)


@click.command(name="help")
@click.argument("topic", nargs=-1)
def help_(topic: tuple[str, ...]) -> None:
    """Show a page of the desktop's help, such as drun, irule, sin, "error 200".

    Without TOPIC a list of all. Other words search the pages. Exit status 1: nothing was found.
    """

    def work() -> int:
        from desire_tui.cli.help_text import show_help

        return show_help(" ".join(topic))

    sys.exit(guarded(work))


@click.command()
@click.argument("words", nargs=-1)
@click.option("--copy", "folder", metavar="DIR", type=click.Path(file_okay=False, path_type=Path),
              help="Copy them to a folder, in their subfolders; files that are there stay.")  # fmt: skip
@click.option("--show", is_flag=True, help="Print the programs themselves.")
def examples(words: tuple[str, ...], folder: Path | None, show: bool) -> None:
    """List the example programs, or those that hold all WORDS.

    Exit status 1: nothing was found.
    """

    def work() -> int:
        from desire_tui.common.paths import examples_folder
        from desire_tui.panes.example_catalogue import examples as all_examples
        from desire_tui.panes.example_catalogue import search

        every = all_examples()
        found = search(" ".join(words), every) if words else every
        if not found:
            sys.stderr.write(
                f"no example holds {' and '.join(map(repr, words))}; `desire examples` lists all\n"
            )
            return 1
        if folder is not None:
            from desire_tui.batch.example_copies import copy_examples

            return copy_examples([example.path for example in found], examples_folder(), folder)
        if show:
            click.echo("\n\n".join(example.text.rstrip() for example in found))
            return 0
        width = max(len(f"{example.folder}/{example.name}") for example in found)
        for example in found:
            click.echo(f"{example.folder}/{example.name}".ljust(width) + f"  {example.about}")
        if sys.stdout.isatty():
            click.echo(
                f"\n{len(found)} programs in {examples_folder()}; `desire examples --copy DIR` copies them"
            )
        return 0

    sys.exit(guarded(work))
