"""What `desire run` does when its words have been read."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

from desire_tui.batch.ending import WrongUsage
from desire_tui.batch.output_files import STANDARD_OUTPUT, OutputFiles
from desire_tui.batch.output_names import clash, make_folders, named_for
from desire_tui.batch.runner import RunOptions
from desire_tui.engine.outputs.formats import FORMATS, DataFormat, OutputFormat
from desire_tui.engine.outputs.picture_options import PictureOptions

if TYPE_CHECKING:
    from collections.abc import Sequence


def run_programs(programs: Sequence[str], options: dict[str, Any]) -> int:
    """Run programs as the options of `desire run` say; return the exit status.

    WrongUsage, before anything runs or is written: what is asked for cannot be.
    """
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


def _check_outputs(outputs: OutputFiles, programs: Sequence[str]) -> None:
    """Refuse what cannot be written before anything runs. WrongUsage."""
    files = outputs.files
    if sum(name == STANDARD_OUTPUT for name in files.values()) > 1:
        raise WrongUsage("only one file can go to standard output")
    if len(programs) > 1:
        if STANDARD_OUTPUT in programs:
            raise WrongUsage("- (standard input) is one program, and runs alone")
        if reason := clash(outputs, programs):
            raise WrongUsage(reason)
    for known in FORMATS:
        if known.name in files:
            _check_library(known)
        is_text = isinstance(known, DataFormat) and known.is_text
        if files.get(known.name) == STANDARD_OUTPUT and not is_text and sys.stdout.isatty():
            raise WrongUsage(
                f"--{known.name} - is nothing that a terminal shows: name a file, or send the output to one"
            )


def _check_library(known: OutputFormat) -> None:
    """Say before the program runs that a format's library is missing, not after an hour of it."""
    from importlib.util import find_spec

    if isinstance(known, DataFormat) and known.needs is not None and find_spec(known.needs) is None:
        raise WrongUsage(f"--{known.name} needs the library {known.needs}: pip install 'desire-tui[data]'")
