"""`desire convert`: models of other programs as Desire programs."""

from __future__ import annotations

import sys

import click

from desire_tui.batch.ending import guarded
from desire_tui.cli.group import PROGRAMS


@click.command()
@click.argument("file", type=PROGRAMS)
@click.option("-o", "--output", metavar="FILE", type=click.Path(allow_dash=True),
              help="Where the program goes; - or nothing: to standard output.")  # fmt: skip
@click.option(
    "--partial", is_flag=True, help="Write the program even if parts of the model are missing in it."
)
def convert(file: str, output: str | None, partial: bool) -> None:
    """Make a Desire program of a model of XPPAUT (.ode) or in SBML (.xml).

    What cannot be taken over is reported with its line, and so is what is done in another way. SBML needs
    pip install 'desire-tui[convert]'. Exit status: 0 the program says all that the model says, 1 not so.
    """

    def work() -> int:
        from desire_tui.batch.convert_file import convert_file

        return convert_file(file, output or "-", partial=partial)

    sys.exit(guarded(work))
