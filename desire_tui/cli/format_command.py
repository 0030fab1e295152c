"""`desire fmt`: programs in the usual layout."""

from __future__ import annotations

import sys

import click

from desire_tui.batch.ending import guarded
from desire_tui.cli.group import PROGRAMS


@click.command()
@click.argument("files", nargs=-1, required=True, type=PROGRAMS)
@click.option(
    "--check", "only_check", is_flag=True, help="Change nothing; exit status 1 if something would change."
)
@click.option("--diff", "show_diff", is_flag=True, help="Change nothing; print what would change.")
def fmt(files: tuple[str, ...], *, only_check: bool, show_diff: bool) -> None:
    """Lay programs out: blanks between words, blocks indented, comments in columns.

    Files are rewritten in place, a folder stands for all programs (.src) below it, - reads standard input and
    prints. What a program says stays as it is, lines that cannot be read too. Exit status: 0 done, 1 a file
    cannot be read or written, or would change.
    """

    def work() -> int:
        from desire_tui.batch.format_files import format_files

        return format_files(files, check=only_check, diff=show_diff)

    sys.exit(guarded(work))
