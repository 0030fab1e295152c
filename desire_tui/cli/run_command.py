"""`desire run`: its options, and what is refused before a program runs."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any, TypeVar

import click

from desire_tui.cli.ending import guarded
from desire_tui.cli.group import PROGRAMS
from desire_tui.engine.outputs.formats import FORMATS, DataFormat, OutputFormat
from desire_tui.engine.outputs.picture_options import DPI_LEAST, DPI_MOST, INCHES_MOST, PictureOptions, inches

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.batch.output_files import OutputFiles

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
    sys.exit(guarded(lambda: _run(files, **options)))


def _run(programs: tuple[str, ...], **options: Any) -> int:
    from desire_tui.batch.output_files import OutputFiles
    from desire_tui.batch.output_names import make_folders, named_for
    from desire_tui.batch.runner import RunOptions

    files = {known.name: options[known.name] for known in FORMATS if options[known.name] is not None}
    picture = PictureOptions(options["size"] or PictureOptions().inches, options["dpi"], options["style"])
    outputs = OutputFiles(files, plot=options["plot"], picture=picture)
    _check_outputs(outputs, programs)
    run_options = RunOptions(
        settings=options["settings"], answer_stops=options["go"], timeout=options["timeout"],
        backend=options["backend"], allow_shell=options["allow_shell"], allow_write=options["allow_write"],
    )  # fmt: skip
    make_folders(outputs)
    answers, quiet, raw = options["answers"], options["quiet"], options["raw"]
    if len(programs) == 1:
        from desire_tui.batch.cli_commands import run_file

        outputs = named_for(outputs, programs[0])
        return run_file(programs[0], run_options, outputs, answers, quiet=quiet, raw=raw)
    import os

    from desire_tui.batch.several_programs import HowToRun, run_files

    how = HowToRun(run_options, outputs, answers, quiet, raw)
    return run_files(programs, how, options["jobs"] or os.cpu_count() or 1)


def _check_outputs(outputs: OutputFiles, programs: tuple[str, ...]) -> None:
    """Refuse what cannot be written before anything runs. UsageError."""
    from desire_tui.batch.output_files import STANDARD_OUTPUT
    from desire_tui.batch.output_names import clash

    files = outputs.files
    if sum(name == STANDARD_OUTPUT for name in files.values()) > 1:
        raise click.UsageError("only one file can go to standard output")
    if len(programs) > 1:
        if STANDARD_OUTPUT in programs:
            raise click.UsageError("- (standard input) is one program, and runs alone")
        if reason := clash(outputs, programs):
            raise click.UsageError(reason)
    for known in FORMATS:
        if known.name in files:
            _check_library(known)
        is_text = isinstance(known, DataFormat) and known.is_text
        if files.get(known.name) == STANDARD_OUTPUT and not is_text and sys.stdout.isatty():
            raise click.UsageError(
                f"--{known.name} - is nothing that a terminal shows: name a file, or send the output to one"
            )


def _check_library(known: OutputFormat) -> None:
    """Say before the program runs that a format's library is missing, not after an hour of it."""
    from importlib.util import find_spec

    if isinstance(known, DataFormat) and known.needs is not None and find_spec(known.needs) is None:
        raise click.UsageError(
            f"--{known.name} needs the library {known.needs}: pip install 'desire-tui[data]'"
        )
