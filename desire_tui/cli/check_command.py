"""`desire check`: the problems of programs, for people or for other tools."""

from __future__ import annotations

import sys

import click

from desire_tui.batch.ending import guarded
from desire_tui.cli.group import PROGRAMS


@click.command()
@click.argument("files", nargs=-1, required=True, type=PROGRAMS)
@click.option("--json", "as_json", is_flag=True, help="Print the problems as JSON.")
@click.option("--sarif", "as_sarif", is_flag=True, help="Print them as SARIF 2.1.0, which code hosts read.")
def check(files: tuple[str, ...], as_json: bool, as_sarif: bool) -> None:
    """Report the problems of programs without running them.

    A folder stands for all programs (.src) below it, and a summary by kind of problem follows. Exit status: 0
    no errors (warnings, perhaps), 1 errors.
    """
    if as_json and as_sarif:
        raise click.UsageError("--json or --sarif, not both: both go to standard output")

    def work() -> int:
        from desire_tui.batch.check_files import check_files

        return check_files(files, "json" if as_json else "sarif" if as_sarif else "text")

    sys.exit(guarded(work))
