"""`desire check`: programs and folders of them in, their problems out, as text, JSON or SARIF."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from desire_tui.batch.cli_commands import DONE, FAILED, STANDARD_INPUT, report, source_named
from desire_tui.batch.program_folder import Summary, programs_below
from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.program_files import is_folder
from desire_tui.engine.session.session import Session

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from desire_tui.engine.diagnostics import Diagnostic

Form = Literal["text", "json", "sarif"]


def check_files(names: Sequence[str], form: Form = "text") -> int:
    """Report the problems of programs; return 1 if any is an error or cannot be read, else 0.

    Text goes to standard error as the problems are found, JSON and SARIF to standard output at the end. A
    folder stands for all programs below it; as text a summary by kind of problem is printed then.
    """
    found: dict[str, list[Diagnostic]] = {}
    for program, problems in _checked(names):
        found.setdefault(program, []).extend(problems)
        if form == "text":
            report(problems)
    if form == "json":
        from desire_tui.batch.check_report import as_json

        sys.stdout.write(as_json(found))
    elif form == "sarif":
        from desire_tui.batch.check_report import as_sarif

        sys.stdout.write(as_sarif(found))
    elif any(_is_folder(name) for name in names):
        summary = Summary()
        for program, problems in found.items():
            if not _is_folder(program):  # what a folder itself is told of is that it cannot be listed
                summary.add(problems)
        sys.stdout.write("".join(f"{line}\n" for line in summary.lines()))
    return FAILED if any(p.severity == "error" for problems in found.values() for p in problems) else DONE


def _is_folder(name: str) -> bool:
    return name != STANDARD_INPUT and is_folder(Path(name))


def _checked(names: Sequence[str]) -> Iterator[tuple[str, Sequence[Diagnostic]]]:
    """Yield each program's name with its problems; a folder's with those of its list."""
    session = Session()
    for name in names:
        if not _is_folder(name):
            yield name, _problems(session, name, quick=False)
            continue
        hidden: list[Diagnostic] = []
        for program in programs_below(name, hidden):
            # many programs: without the JACOBIANs, for which scripts are carried out
            yield program, _problems(session, program, quick=True)
        if hidden:
            yield name, hidden


def _problems(session: Session, name: str, *, quick: bool) -> Sequence[Diagnostic]:
    try:
        return session.check(source_named(name), quick=quick)
    except DesireError as error:
        return error.diagnostics
