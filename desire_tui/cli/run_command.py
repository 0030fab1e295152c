"""`desire run`: its options."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any, TypeVar

import click

from desire_tui.batch.ending import WrongUsage, guarded
from desire_tui.cli.group import PROGRAMS
from desire_tui.engine.outputs.formats import FORMATS
from desire_tui.engine.outputs.picture_options import DPI_LEAST, DPI_MOST, INCHES_MOST, inches

if TYPE_CHECKING:
    from collections.abc import Callable

_OUTPUT = click.Path(writable=False, readable=False, allow_dash=True)
_Command = TypeVar("_Command", bound="Callable[..., Any]")


def settings(_: click.Context, __: click.Parameter, values: tuple[str, ...]) -> dict[str, float]:
    """Read `--set`."""
    if not values:
        return {}
    from desire_tui.batch.set_option import from_texts

    try:
        return from_texts(values)
    except ValueError as wrong:
        raise click.BadParameter(
            f"'{wrong}' is not NAME=NUMBER, NAME[2]=NUMBER, NAME=1,2,3 or NAME=1,2;3,4"
        ) from None


def _inches(_: click.Context, __: click.Parameter, text: str | None) -> tuple[float, float] | None:
    if text is None:
        return None
    size = inches(text)
    if size is None:
        raise click.BadParameter(f"'{text}' is not WIDTHxHEIGHT in inches, from 1 to {INCHES_MOST}: 8x5")
    return size


def _output_options(command: _Command) -> _Command:
    """Add an option for each format that results can be written in."""
    for known in reversed(FORMATS):
        command = click.option(f"--{known.name}", metavar="F", type=_OUTPUT, help=known.about)(command)
    return command


@click.command()
@click.argument("files", nargs=-1, required=True, type=PROGRAMS)
@_output_options
@click.option("-j", "--jobs", metavar="N", type=click.IntRange(0), default=1, show_default=True,
              help="Run N of several programs at once; 0: as many as there are processors.")  # fmt: skip
@click.option("--plot", is_flag=True, help="Print the last graph as text.")
@click.option("--size", metavar="WxH", callback=_inches, help="Size of pictures in inches. [default: 8x5]")
@click.option("--dpi", metavar="N", type=click.FloatRange(DPI_LEAST, DPI_MOST), default=150,
              show_default=True, help="Dots per inch of pictures; print wants 300.")  # fmt: skip
@click.option("--style", type=click.Choice(["paper", "screen"]),
              help="Pictures dark on white, or in the program's colours. [default: paper, unless it uses "
              "display N or C]")  # fmt: skip
@click.option("--set", "settings", multiple=True, metavar="NAME=VALUE", callback=settings,
              help="Override the script's own values: a=3, v[2]=3, v=1,2,3, A=1,2;3,4.")  # fmt: skip
@click.option("--go", is_flag=True, help="Continue after every STOP.")
@click.option("--input", "answers", metavar="F", type=_OUTPUT, help="File with the lines that `input` reads.")
@click.option("--quiet", is_flag=True, help="No console text.")
@click.option("--raw", is_flag=True, help="Write control characters to a terminal as they are (`write $27`).")
@click.option(
    "--timeout", type=click.FloatRange(min=0, min_open=True), metavar="S", help="End after S seconds."
)
@click.option("--allow-shell", is_flag=True, help="Let the program run shell commands.")
@click.option(
    "--allow-write", is_flag=True, help="Let the program use any files, not only data in its folder."
)
@click.option("--backend", type=click.Choice(["native", "reference"]), default="native", show_default=True,
              help="Compiled code, or NumPy.")  # fmt: skip
def run(files: tuple[str, ...], **options: Any) -> None:
    """Run programs without a screen. A file may be - (standard input), output files too (standard output).

    Console text goes to standard output, problems to standard error. Of several programs each
    runs in a process of its own, and their output comes in their order; F is then a folder (results/) or a
    name with {}, which stands for the program's name. Exit status: 0 done, 1 a program failed, 2 wrong usage,
    3 stopped by a limit or Ctrl-C.
    """

    def work() -> int:
        from desire_tui.batch.run_programs import run_programs  # Ctrl-C may come while this loads

        return run_programs(files, options)

    try:
        sys.exit(guarded(work))
    except WrongUsage as wrong:
        raise click.UsageError(str(wrong)) from None
