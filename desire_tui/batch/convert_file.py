"""`desire convert`: a model in, a program out, what is to be said about it on standard error."""

from __future__ import annotations

import sys
from pathlib import Path

from desire_tui.batch.cli_commands import DONE, FAILED, report, source_named
from desire_tui.convert.conversion import convert
from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.files import write_file


def convert_file(name: str, output: str, *, partial: bool) -> int:
    """Convert a model; returns the exit status. `output`: a file's name, `-` for standard output.

    A program in which parts of the model are missing is written if `partial`.
    """
    try:
        conversion = convert(source_named(name))
        report(conversion.problems)
        if conversion.complete or partial:
            if output == "-":
                sys.stdout.write(conversion.text)
            else:
                write_file(Path(output), lambda file: file.write(conversion.text))
    except DesireError as error:
        report(error.diagnostics)
        return FAILED
    return DONE if conversion.complete else FAILED
