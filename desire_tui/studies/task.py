"""What every run of a study has in common: all that another machine needs to make some."""

from __future__ import annotations

from hashlib import blake2b
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.source import Source

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.engine.diagnostics import Diagnostic
    from desire_tui.engine.session.session import BackendName

    Floats = NDArray[np.float64]

WITHOUT_NUMBER = -1
"""Stands for the number of an error that has none."""


@dataclass(frozen=True)
class Task:
    """A program and how it runs. `names` vary; `fixed` have one value in all runs; `keep` is what is kept."""

    text: str
    name: str
    path: str | None
    keep: str
    names: tuple[str, ...]
    fixed: tuple[tuple[str, float], ...] = ()
    seed: int | None = None
    segment: str | None = None
    answers: tuple[str, ...] = ()
    backend: BackendName = "native"
    allow_shell: bool = False
    allow_write: bool = False
    fast: bool = False
    """Vector code may take the vector library's functions (4 units in the last place)."""
    lanes: bool = True
    """Runs may be made several at a time in vector code; the numbers are the same."""

    @property
    def source(self) -> Source:
        """The program."""
        return Source(self.text, self.name, None if self.path is None else Path(self.path))

    @property
    def digest(self) -> str:
        """A digest of the program's text."""
        return blake2b(self.text.encode(), digest_size=12).hexdigest()


class Failures:
    """Why runs failed: by errors' numbers the first run, its message, and how many there were."""

    def __init__(self) -> None:
        self.by_code: dict[int, tuple[int, str, int]] = {}
        """(first run, its message, runs)"""

    def is_new(self, problem: Diagnostic) -> bool:
        """Whether no run failed for this reason yet."""
        return (problem.code or WITHOUT_NUMBER) not in self.by_code

    def note(self, run: int, problem: Diagnostic, message: str | None = None) -> int:
        """Note a run that failed, with the problem's message or another; return the error's number."""
        code = problem.code or WITHOUT_NUMBER
        self._add(code, run, message or problem.message, 1)
        return code

    def merge(self, other: Failures) -> None:
        """Add those of other runs."""
        for code, (run, message, count) in other.by_code.items():
            self._add(code, run, message, count)

    def _add(self, code: int, run: int, message: str, count: int) -> None:
        first, said, before = self.by_code.get(code, (run, message, 0))
        if run < first:
            first, said = run, message
        self.by_code[code] = first, said, before + count

    @property
    def count(self) -> int:
        """How many runs failed."""
        return sum(count for _, _, count in self.by_code.values())

    def lines(self) -> list[str]:
        """Say how many runs failed and why, the most frequent reason first."""
        ordered = sorted(self.by_code.items(), key=lambda item: (-item[1][2], item[0]))
        return [
            f"{count} run{'s' * (count != 1)}: {f'error {code}: ' if code > 0 else ''}{message}"
            f" ({'first: ' * (count > 1)}run {run})"
            for code, (run, message, count) in ordered
        ]


class Chunk(NamedTuple):
    """What some runs gave: (runs, numbers), nan where a run failed, whose error number is not 0 then."""

    first: int
    numbers: Floats
    errors: NDArray[np.int16]
    failures: Failures

    @classmethod
    def empty(cls, first: int, runs: int, size: int) -> Chunk:
        """Return a chunk of holes, to be filled."""
        return cls(first, np.full((runs, size), np.nan), np.zeros(runs, dtype=np.int16), Failures())
