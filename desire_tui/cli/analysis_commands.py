"""`desire fit`, `desire steady` …: one command for each analysis of the table."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

import click

from desire_tui.analysis.registry import ANALYSES
from desire_tui.batch.ending import guarded
from desire_tui.cli.group import PROGRAMS
from desire_tui.cli.run_command import settings

if TYPE_CHECKING:
    from desire_tui.analysis.registry import Analysis

_OPTIONS = (
    click.Option(["-o", "--output"], multiple=True, metavar="F",
                 help="Where results go: .csv, .json, .png, .svg or .pdf; may be repeated."),
    click.Option(["--data"], multiple=True, metavar="F", type=click.Path(readable=False),
                 help="Measurements: a CSV file with names in its first line; may be repeated."),
    click.Option(["--set", "settings"], multiple=True, metavar="NAME=VALUE", callback=settings,
                 help="Override the script's own values."),
    click.Option(["--input", "answers"], metavar="F", help="File with the lines that `input` reads."),
    click.Option(["--segment"], metavar="LABEL", help="The labelled segment whose run is meant."),
    click.Option(["--quiet"], is_flag=True, help="No progress, no text."),
    click.Option(["--allow-shell"], is_flag=True, help="Let the program run shell commands."),
    click.Option(["--allow-write"], is_flag=True, help="Let the program use any files."),
    click.Option(["--backend"], type=click.Choice(["native", "reference"]), default="native",
                 show_default=True, help="Compiled code, or NumPy."),
)  # fmt: skip


def analysis_commands() -> list[click.Command]:
    """Return a command for each analysis."""
    return [_command(analysis) for analysis in ANALYSES]


def _command(analysis: Analysis) -> click.Command:
    def work(file: str, request: tuple[str, ...], **options: Any) -> None:
        def analyse() -> int:
            from desire_tui.analysis.command import analyse_file

            return analyse_file(analysis, file, " ".join(request), options)

        sys.exit(guarded(analyse))

    asked = f"REQUEST: {analysis.form}\n\nFor instance: {analysis.example}\n\n" if analysis.form else ""
    status = "Exit status: 0 done, 1 nothing was found, 2 wrong usage, 3 stopped by Ctrl-C."
    return click.Command(
        analysis.name,
        callback=work,
        params=[
            click.Argument(["file"], type=PROGRAMS),
            click.Argument(["request"], nargs=-1),
            *_OPTIONS,
        ],
        help=f"{analysis.summary}.\n\n{asked}{status}",
        short_help=analysis.summary,
    )
