"""`desire fmt`: programs and folders of them, rewritten in the usual layout."""

from __future__ import annotations

import sys
from difflib import unified_diff
from pathlib import Path
from typing import TYPE_CHECKING

from desire_tui.batch.cli_commands import DONE, FAILED, STANDARD_INPUT, report
from desire_tui.batch.program_folder import programs_below
from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.files import decoded, read_encoded, write_bytes
from desire_tui.engine.program_files import is_folder
from desire_tui.engine.text_encoding import UTF_8, encode
from desire_tui.engine.visible_text import visible_line
from desire_tui.language.formatter import formatted

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence


def format_files(names: Sequence[str], *, check: bool, diff: bool) -> int:
    """Lay programs out in place; return 1 if one cannot be read or written, or would change, else 0.

    `check` only names them, `diff` prints what would change; standard input goes to standard output.
    """
    problems: list[Diagnostic] = []
    changed = 0
    for name in _programs(names, problems):
        try:
            changed += _format(name, check=check, diff=diff)
        except DesireError as error:
            problems.extend(error.diagnostics)
    report(problems)
    return FAILED if problems or (changed and (check or diff)) else DONE


def _programs(names: Sequence[str], problems: list[Diagnostic]) -> Iterator[str]:
    for name in names:
        if name != STANDARD_INPUT and is_folder(Path(name)):
            yield from programs_below(name, problems)
        else:
            yield name


def _format(name: str, *, check: bool, diff: bool) -> bool:
    """Lay one program out; return whether that changes it. DesireError 38, 106."""
    if name == STANDARD_INPUT:
        before, encoding = decoded(sys.stdin.buffer.read(), "<stdin>"), UTF_8
    else:
        before, encoding = read_encoded(Path(name))
    after = formatted(before)
    if diff:
        rows = (before.splitlines(keepends=True), after.splitlines(keepends=True))
        for row in unified_diff(*rows, name, name):
            sys.stdout.write(row if row.endswith("\n") else f"{row}\n\\ No newline at end of file\n")
    elif check:
        if after != before:
            sys.stderr.write(f"{visible_line(name)}: would change\n")
    elif name == STANDARD_INPUT:
        sys.stdout.write(after)
    elif after != before:
        data = encode(after, encoding)
        write_bytes(Path(name), lambda file: file.write(data))
        sys.stderr.write(f"{visible_line(name)}: laid out\n")
    return after != before
