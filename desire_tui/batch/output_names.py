"""Names of output files: as given, or made from the program's own name."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from desire_tui.batch.output_files import STANDARD_OUTPUT
from desire_tui.engine.data_classes import replace
from desire_tui.engine.outputs.formats import FORMATS
from desire_tui.engine.program_files import is_folder

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.batch.output_files import OutputFiles

PLACE = "{}"
"""What the program's name takes the place of: `out/{}-fine.csv`."""
_ENDINGS = {known.name: known.ending for known in FORMATS}


def file_of(kind: str, name: str, program: str) -> str:
    """Return where a program's output of a kind (`png`) goes.

    A `{}` in `name` becomes the program's name without its ending; in a folder (`out/`, or one that is there)
    that is the file's name. Anything else is taken as it is.
    """
    if name == STANDARD_OUTPUT:
        return name
    stem = "stdin" if program == STANDARD_OUTPUT else Path(program).stem
    if PLACE in name:
        return name.replace(PLACE, stem)
    if name.endswith("/") or is_folder(Path(name)):
        return str(Path(name) / f"{stem}{_ENDINGS[kind]}")
    return name


def named_for(outputs: OutputFiles, program: str) -> OutputFiles:
    """Return the outputs of one program."""
    return replace(
        outputs, files={kind: file_of(kind, name, program) for kind, name in outputs.files.items()}
    )


def make_folders(outputs: OutputFiles) -> None:
    """Make the folders that were named by a `/` at their end. OSError: one cannot be made."""
    for name in outputs.files.values():
        if name.endswith("/"):
            Path(name).mkdir(parents=True, exist_ok=True)


def clash(outputs: OutputFiles, programs: Sequence[str]) -> str | None:
    """Return a sentence about two programs that would write one file; None if there are none."""
    owners: dict[str, str] = {}
    for program in programs:
        for kind, name in named_for(outputs, program).files.items():
            if name == STANDARD_OUTPUT:
                return f"--{kind} - is for one program; of several, name a folder: --{kind} results/"
            owner = owners.setdefault(name, program)
            if owner != program and PLACE not in outputs.files[kind] and not _is_folder(outputs.files[kind]):
                return (
                    f"every program would write {name}: name a folder, --{kind} results/, "
                    f"or say where the program's name goes, --{kind} 'results/{PLACE}{_ENDINGS[kind]}'"
                )
            if owner != program:
                return f"{owner} and {program} would both write {name}: run them apart"
    return None


def _is_folder(name: str) -> bool:
    return name.endswith("/") or is_folder(Path(name))
