"""A study before its first run: its task, its design, what it keeps, and whether that fits."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.version import __version__

if TYPE_CHECKING:
    from collections.abc import Iterator

    from desire_tui.studies.design import Design
    from desire_tui.studies.keep import KeptList
    from desire_tui.studies.task import Task

_NUMBER, _ERROR = 8, 2
"""Bytes of a number kept, of an error's number."""
_WRITTEN = 16
"""Bytes of a number in a table, at least as a rule."""
_HYPERCUBE = 3
"""So many arrays of a whole design are in memory when scipy makes a Latin hypercube."""
_ALLOWED = 0.8
"""Of what is free."""


@dataclass(frozen=True)
class Plan:
    """Everything that is decided before the first run. `way`: `prepared`, `script`."""

    task: Task
    design: Design
    kept: KeptList

    @property
    def runs(self) -> int:
        """How many runs there are."""
        return self.design.runs

    @property
    def bytes(self) -> int:
        """How much the result takes."""
        drawn = self.design.draws * (len(self.design.names) - len(self.design.axes) + 1)
        return self.runs * (self.kept.size * _NUMBER + _ERROR) + drawn * _NUMBER

    def description(self) -> dict[str, object]:
        """Return what makes it the same study again, in plain numbers and texts."""
        task = self.task
        return {
            "program": task.digest,
            "keep": task.keep,
            "varies": list(self.design.names),
            **self.design.description(),
            "fixed": dict(task.fixed),
            "seed of the runs": task.seed,
            "segment": task.segment,
            "input": list(task.answers),
            "back end": task.backend,
            "fast": task.fast,
            "desire-tui": __version__,
        }

    def check_memory(self, *, keeps_results: bool) -> None:
        """DesireError 512: what has to be in memory does not fit there."""
        wanted = self.bytes if keeps_results else 0
        if self.design.method == "latin":
            wanted += _HYPERCUBE * self.design.draws * len(self.design.names) * _NUMBER
        remedy = "keep less, make fewer runs, or write to a .zarr folder, which is filled piece by piece"
        if not keeps_results:
            remedy = "draw them with --design random or sobol, which are made piece by piece"
        self._check(wanted, "the machine's memory", _memory_free(), remedy)

    def check_disk(self, path: Path) -> None:
        """DesireError 512: the result does not fit on a file's disk."""
        wanted = self.bytes
        if path.suffix == ".csv":
            wanted = self.runs * (self.kept.size + len(self.design.names) + 1) * _WRITTEN
        free = shutil.disk_usage(_existing(path)).free
        self._check(wanted, f"the disk of {path}", free, "keep less, make fewer runs, or write elsewhere")

    def _check(self, wanted: int, where: str, free: int, remedy: str) -> None:
        if wanted > _ALLOWED * free:
            facts = {"runs": self.runs, "numbers": self.kept.size, "where": where, "remedy": remedy}
            facts |= {"size": _size(wanted), "free": _size(free)}
            raise DesireError(Diagnostic("study-too-large", None, facts))


def _size(number: int) -> str:
    """Return so many bytes with a unit that people know."""
    for unit, factor in (("TB", 1e12), ("GB", 1e9), ("MB", 1e6), ("kB", 1e3)):
        if number >= factor:
            return f"{number / factor:.3g} {unit}"
    return f"{number} B"


def _existing(folder: Path) -> Path:
    """Return the nearest folder that is there."""
    return next((each for each in (folder, *folder.absolute().parents) if each.exists()), Path("/"))


def _memory_free() -> int:
    """Return how many bytes programs may take without others being put out of memory."""
    import os

    try:
        for line in Path("/proc/meminfo").read_text("ascii").splitlines():
            if line.startswith("MemAvailable:"):
                return int(line.split()[1]) * 1024
    except OSError:
        pass
    return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") // 2


def boxes(first: int, count: int, shape: tuple[int, ...]) -> Iterator[tuple[slice, ...]]:
    """Yield the boxes of an array that neighbouring runs fill, in their order."""
    if len(shape) == 1:
        yield (slice(first, first + count),)
        return
    inner = 1
    for size in shape[1:]:
        inner *= size
    end = first + count
    while first < end:
        row, at = divmod(first, inner)
        if at == 0 and end - first >= inner:
            last = end // inner
            yield (slice(row, last), *(slice(0, size) for size in shape[1:]))
            first = last * inner
        else:
            part = min(end - first, inner - at)
            for box in boxes(at, part, shape[1:]):
                yield (slice(row, row + 1), *box)
            first += part
