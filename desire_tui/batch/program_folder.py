"""`desire check FOLDER`: the programs below a folder, and what is wrong with them by kind of problem."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import Diagnostic

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

ENDING = ".src"


def programs_below(folder: str, cannot_list: list[Diagnostic]) -> Iterator[str]:
    """Yield the programs below a folder by name; links to folders are not followed.

    Folders that cannot be listed are noted.
    """

    def note(error: OSError) -> None:
        facts = {"path": error.filename, "reason": error.strerror or error}
        cannot_list.append(Diagnostic("file-unreadable", facts=facts))

    for place, folders, files in os.walk(folder, onerror=note):
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        for name in sorted(files):
            path = Path(place, name)
            if path.suffix.lower() == ENDING and path.is_file():
                yield str(path)


class Summary:
    """Counts problems of several programs by their kind."""

    def __init__(self) -> None:
        self._programs = self._wrong = 0
        self._kinds: dict[tuple[str, int, str], list[int]] = {}

    def add(self, problems: Sequence[Diagnostic]) -> None:
        """Count one program's problems."""
        self._programs += 1
        self._wrong += any(p.severity == "error" for p in problems)
        kinds = [(p.severity, p.code, Diagnostic(p.key).message) for p in problems]
        for kind in kinds:
            self._kinds.setdefault(kind, [0, 0])[1] += 1
        for kind in set(kinds):
            self._kinds[kind][0] += 1

    def lines(self) -> Iterable[str]:
        """Return the summary, the kind of problem that most programs have first."""
        yield f"programs: {self._programs}, with errors: {self._wrong}"
        if self._kinds:
            yield "programs  places  problem"
        for (severity, code, message), (programs, places) in sorted(
            self._kinds.items(), key=lambda item: (-item[1][0], -item[1][1], item[0])
        ):
            yield f"{programs:8}{places:8}  {severity} {code}: {message}"
