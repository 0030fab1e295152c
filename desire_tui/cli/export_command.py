"""`desire export`: models for other tools."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from desire_tui.batch.ending import guarded
from desire_tui.cli.group import PROGRAMS
from desire_tui.cli.run_command import settings
from desire_tui.export.formats import FORMATS

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.export.formats import ExportFormat


def _formats(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add an option for each format."""
    for known in reversed(FORMATS):
        command = click.option(f"--{known.name}", is_flag=True, help=f"{known.about}.")(command)
    return command


@click.command()
@click.argument("file", type=PROGRAMS)
@_formats
@click.option("-o", "--output", metavar="F", help="Where it goes; - is standard output. [default: here]")
@click.option("--inputs", metavar="NAMES", help="Parameters that an FMU gets from others while it runs: u,w.")
@click.option("--set", "settings", multiple=True, metavar="NAME=VALUE", callback=settings,
              help="Override the script's own values.")  # fmt: skip
@click.option("--input", "answers", metavar="F", help="File with the lines that `input` reads.")
@click.option("--segment", metavar="LABEL", help="The labelled segment whose run is meant.")
@click.option("--allow-shell", is_flag=True, help="Let the program run shell commands.")
@click.option("--allow-write", is_flag=True, help="Let the program use any files.")
def export(file: str, **options: Any) -> None:
    """Write a program's run in the form of another tool.

    The run is the script's first one, with the values that it begins with. The ending of the output file
    chooses the format if no option does. Exit status: 0 done, 1 it cannot be written, 2 wrong usage.
    """
    output: str | None = options.pop("output")
    wanted = [known for known in FORMATS if options.pop(known.name)]
    known = _chosen(wanted, output)

    def work() -> int:
        from desire_tui.export.command import export_file

        return export_file(file, known, output, options)

    sys.exit(guarded(work))


def _chosen(wanted: list[ExportFormat], output: str | None) -> ExportFormat:
    """Return the format. UsageError: none, or several."""
    if not wanted and output is not None:
        wanted = [known for known in FORMATS if Path(output).suffix.lower() == known.ending]
    names = ", ".join(f"--{known.name}" for known in FORMATS)
    if len(wanted) != 1:
        raise click.UsageError(f"one format is to be chosen: {names}")
    return wanted[0]
