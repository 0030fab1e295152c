"""The command line: `desire run`, `desire check`, `desire config`, `desire serve`, and all options."""

from __future__ import annotations

import sys
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, TypeVar

import click

from desire_tui.engine.outputs.formats import FORMATS, DataFormat, OutputFormat
from desire_tui.engine.outputs.picture_options import DPI_LEAST, DPI_MOST, INCHES_MOST, PictureOptions, inches
from desire_tui.engine.user_folders import ignored_variables
from desire_tui.engine.visible_text import visible
from desire_tui.version import __version__

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

_Command = TypeVar("_Command", bound="Callable[..., Any]")


class _FilesOrCommand(click.Group):
    """A first word that is no command is a file for the desktop."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        first = next((a for a in args if not a.startswith("-")), None)
        if first is not None and first not in self.commands:
            args = ["ide", *args]
        return super().parse_args(ctx, args)

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


@click.group(cls=_FilesOrCommand, invoke_without_command=True)
@click.version_option(__version__, prog_name="desire")
@click.pass_context
def main(context: click.Context) -> None:
    """Desire: interactive dynamic-system simulation in the terminal.

    `desire [FILE…]` opens the desktop.
    """
    if context.invoked_subcommand is None:
        _open_desktop(())


@main.command(name="ide", hidden=True)
@click.argument("files", nargs=-1)
def ide(files: tuple[str, ...]) -> None:
    """Open the desktop."""
    _open_desktop(files)


def _open_desktop(files: tuple[str, ...]) -> None:
    from desire_tui.launch import is_possible, open_desktop

    if not is_possible():
        raise click.UsageError("the desktop needs a terminal; `desire run FILE` works without one")
    open_desktop(files)


def _settings(_: click.Context, __: click.Parameter, values: tuple[str, ...]) -> dict[str, float]:
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
        command = click.option(f"--{known.name}", metavar="F", help=known.about)(command)
    return command


@main.command()
@click.argument("file")
@_output_options
@click.option("--plot", is_flag=True, help="Print the last graph as text.")
@click.option("--size", metavar="WxH", callback=_inches, help="Size of pictures in inches. [default: 8x5]")
@click.option("--dpi", type=click.FloatRange(DPI_LEAST, DPI_MOST), default=150, show_default=True,
              help="Dots per inch of pictures; print wants 300.")  # fmt: skip
@click.option("--style", type=click.Choice(["paper", "screen"]),
              help="Pictures dark on white, or in the program's colours. [default: paper, unless it uses "
              "display N or C]")  # fmt: skip
@click.option("--set", "settings", multiple=True, metavar="NAME=VALUE", callback=_settings,
              help="Override the script's own values: a=3, v[2]=3, v=1,2,3, A=1,2;3,4.")  # fmt: skip
@click.option("--go", is_flag=True, help="Continue after every STOP.")
@click.option("--input", "answers", metavar="F", help="File with the lines that `input` reads.")
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
def run(file: str, **options: Any) -> None:
    """Run a program without a screen. FILE may be - (standard input), output files too (standard output).

    Console text goes to standard output, problems to standard error. Exit status: 0 done, 1 the program
    failed, 2 wrong usage, 3 stopped by a limit or Ctrl-C.
    """
    sys.exit(_guarded(lambda: _run(file, **options)))


def _run(file: str, **options: Any) -> int:
    from desire_tui.batch.cli_commands import run_file
    from desire_tui.batch.output_files import STANDARD_OUTPUT, OutputFiles
    from desire_tui.batch.runner import RunOptions

    files = {known.name: options[known.name] for known in FORMATS if options[known.name] is not None}
    if sum(name == STANDARD_OUTPUT for name in files.values()) > 1:
        raise click.UsageError("only one file can go to standard output")
    for known in FORMATS:
        if known.name in files:
            _check_library(known)
        is_text = isinstance(known, DataFormat) and known.is_text
        if files.get(known.name) == STANDARD_OUTPUT and not is_text and sys.stdout.isatty():
            raise click.UsageError(
                f"--{known.name} - is nothing that a terminal shows: name a file, or send the output to one"
            )
    run_options = RunOptions(
        settings=options["settings"], answer_stops=options["go"], timeout=options["timeout"],
        backend=options["backend"], allow_shell=options["allow_shell"], allow_write=options["allow_write"],
    )  # fmt: skip
    picture = PictureOptions(options["size"] or PictureOptions().inches, options["dpi"], options["style"])
    outputs = OutputFiles(files, plot=options["plot"], picture=picture)
    return run_file(
        file, run_options, outputs, options["answers"], quiet=options["quiet"], raw=options["raw"]
    )


def _check_library(known: OutputFormat) -> None:
    """Say before the program runs that a format's library is missing, not after an hour of it."""
    from importlib.util import find_spec

    if isinstance(known, DataFormat) and known.needs is not None and find_spec(known.needs) is None:
        raise click.UsageError(
            f"--{known.name} needs the library {known.needs}: pip install 'desire-tui[data]'"
        )


@main.command()
@click.argument("files", nargs=-1, required=True)
def check(files: tuple[str, ...]) -> None:
    """Report the problems of programs without running them.

    A folder stands for all programs (.src) below it, and a summary by kind of problem follows. Exit status: 0
    no errors (warnings, perhaps), 1 errors.
    """

    def work() -> int:
        from desire_tui.batch.cli_commands import check_files

        return check_files(files)

    sys.exit(_guarded(work))


@main.command()
def config() -> None:
    """Print where the configuration file is, and what it may hold."""
    from desire_tui.common.config import defaults_text
    from desire_tui.common.paths import config_file

    click.echo(f"# {config_file()}")
    click.echo(defaults_text(), nl=False)


_ALLOWANCES = (
    click.option("--allow-shell", is_flag=True, help="Let visitors and programs run shell commands."),
    click.option(
        "--allow-write", is_flag=True, help="Let visitors and programs use files outside the folder."
    ),
)


@main.command()
@click.argument("files", nargs=-1)
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
    commands are refused.
    """
    from desire_tui.serve.start import CannotServe, start

    try:
        start(files, host, port, public_url, **options)
    except CannotServe as reason:
        raise click.UsageError(str(reason)) from None


@main.command(hidden=True)
@click.argument("files", nargs=-1)
@_ALLOWANCES[0]
@_ALLOWANCES[1]
def served(files: tuple[str, ...], *, allow_shell: bool, allow_write: bool) -> None:
    """Be the desktop of a visitor: `serve` starts it."""
    from desire_tui.launch import is_served, open_desktop

    if not is_served():
        raise click.UsageError("`desire serve` starts this")
    open_desktop(files, allow_shell=allow_shell, allow_write=allow_write)


def _guarded(work: Any) -> int:
    """Run a command; what the machine refuses (a closed pipe, a full disk) is a message, not a traceback."""
    import os

    for sentence in ignored_variables():
        sys.stderr.write(f"warning: {visible(sentence)}\n")
    try:
        status = int(work())
        sys.stdout.flush()
    except BrokenPipeError:
        # the reader of our output has left (`| head`): nothing more to say, and nothing to flush at exit
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    except KeyboardInterrupt:
        sys.stderr.write("stopped by the user\n")
        return 3
    except OSError as reason:
        sys.stderr.write(f"error 106: cannot write: {reason.strerror or reason}\n")
        return 1
    return status
