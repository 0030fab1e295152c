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

    def check_room(self, folder: Path | None) -> None:
        """DesireError 512: the result fits neither into memory nor (`folder`) on the disk."""
        where = "the machine's memory" if folder is None else f"the disk of {folder}"
        free = _memory_free() if folder is None else shutil.disk_usage(_existing(folder)).free
        if self.bytes > _ALLOWED * free:
            facts = {
                "runs": self.runs,
                "numbers": self.kept.size,
                "gigabytes": self.bytes / 1e9,
                "where": where,
                "free": free / 1e9,
            }
            raise DesireError(Diagnostic("study-too-large", None, facts))


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
