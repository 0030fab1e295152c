"""`desire export`: a program in, a file of another tool out."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from desire_tui.batch.cli_commands import DONE, FAILED, STANDARD_INPUT, report, source_named
from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.files import read_source, write_bytes
from desire_tui.export.formats import Export

if TYPE_CHECKING:
    from desire_tui.export.formats import ExportFormat


def export_file(name: str, known: ExportFormat, output: str | None, options: dict[str, Any]) -> int:
    """Write a program in a format; returns the exit status: 0 done, 1 it cannot be."""
    answers = options["answers"]
    try:
        export = Export(
            source_named(name),
            options["settings"],
            options["segment"],
            () if answers is None else tuple(read_source(Path(answers)).text.splitlines()),
            options["allow_shell"],
            options["allow_write"],
            tuple(name.strip() for name in (options["inputs"] or "").split(",") if name.strip()),
        )
        content = known.content(export)
        if output == "-" or (output is None and name == STANDARD_INPUT):
            sys.stdout.buffer.write(content)
            return DONE
        path = Path(output) if output is not None else Path(name).with_suffix(known.ending).name
        write_bytes(Path(path), lambda file: file.write(content))
    except DesireError as error:
        report(error.diagnostics)
        return FAILED
    sys.stdout.write(f"{path}\n")
    return DONE
