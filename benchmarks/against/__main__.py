"""Whether anything has become slower: `python -m benchmarks.against TREE [WORD …]`.

TREE is a folder with another version of the package (`git worktree add TREE COMMIT`). Each work (`worker`)
whose name holds one of the words is done in both versions in turn, each in a process of its own with stores
of its own. Printed are both versions' processor time and the ratio: the median over all pairs, and its
quartiles. Several processes of each version take part: where things happen to lie in memory makes a process
up to 3 % quicker or slower. Several threads (from 10^5 states on) take more processor time, and less time.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from contextlib import ExitStack
from pathlib import Path
from statistics import median, quantiles
from typing import IO, TYPE_CHECKING

from benchmarks.against.worker import WORKS

if TYPE_CHECKING:
    from typing import Self

ROOT = Path(__file__).parents[2]
PROCESSES, PAIRS = 3, 8
SAMPLE_SECONDS = 0.04
"""A work is repeated until it takes this long."""
LIMIT = 1.02
_WORKER = (  # the package comes from the version's folder, what is done with it from here
    f"import sys, desire_tui; sys.path.insert(0, {str(ROOT)!r})\n"
    "from benchmarks.against.worker import serve; serve()"
)
Pairs = list[tuple[float, float]]
"""Seconds of the other version and of this one, measured in turn."""


class CannotBeDoneError(Exception):
    """A version does not know what a work is made of."""


class Version:
    """A process that does works in one version of the package."""

    def __init__(self, tree: Path, folder: Path) -> None:
        folder.mkdir(exist_ok=True)
        environment = {
            **os.environ, "PYTHONPATH": str(tree), "OPENBLAS_NUM_THREADS": "1",
            **{f"XDG_{kind}_HOME": str(folder / kind.lower()) for kind in ("CACHE", "CONFIG", "STATE")},
        }  # fmt: skip
        environment.pop("PYTHONDONTWRITEBYTECODE", None)
        self._process = subprocess.Popen(
            [sys.executable, "-c", _WORKER],
            env=environment, cwd=folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
        )  # fmt: skip
        orders, answers = self._process.stdin, self._process.stdout
        assert orders is not None
        assert answers is not None
        self._orders: IO[str] = orders
        self._answers: IO[str] = answers

    def ask(self, order: str) -> float:
        """Let the process do an order (`worker.serve`); return the seconds it answers."""
        self._orders.write(order + "\n")
        self._orders.flush()
        answer = self._answers.readline()
        try:
            return float(answer)
        except ValueError:
            raise CannotBeDoneError(f"{order}: {answer}") from None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._process.kill()
        self._process.wait()


def pairs(name: str, old: Version, new: Version) -> Pairs:
    """Measure a work in both versions, in turn."""
    once = max(version.ask(f"prepare {name}") for version in (old, new))
    count = max(1, round(SAMPLE_SECONDS / max(once, 1e-6)))
    found = []
    for number in range(PAIRS):
        first, second = (old, new) if number % 2 else (new, old)
        times = {version: version.ask(f"repeat {count}") / count for version in (first, second)}
        found.append((times[old], times[new]))
    for version in (old, new):
        version.ask("forget")
    return found


def main(arguments: list[str]) -> None:
    """Print the table, and again at its end what has become slower."""
    tree, words = Path(arguments[0]).resolve(), arguments[1:]
    found: dict[str, Pairs] = {name: [] for name in WORKS if not words or any(word in name for word in words)}
    with tempfile.TemporaryDirectory(prefix="desire-against-") as folder:
        for turn in range(1, PROCESSES + 1):
            with ExitStack() as stack:
                old = stack.enter_context(Version(tree, Path(folder, "old")))
                new = stack.enter_context(Version(ROOT, Path(folder, "new")))
                for name in [*found]:
                    try:
                        found[name] += pairs(name, old, new)
                    except CannotBeDoneError as problem:
                        print(problem, flush=True)
                        del found[name]
                        continue
                    if turn == PROCESSES:
                        print(_row(name, found[name]), flush=True)
    slower = [name for name, times in found.items() if median(b / a for a, b in times) > LIMIT]
    print(f"\nabove {LIMIT}: {len(slower)} of {len(found)}")
    for name in slower:
        print(_row(name, found[name]))


def _row(name: str, found: Pairs) -> str:
    low, middle, high = quantiles((new / old for old, new in found), n=4)
    old, new = (1e3 * median(times) for times in zip(*found, strict=True))
    return f"{name:50} {old:10.3f} {new:10.3f} ms  {middle:6.3f}  {low:6.3f} … {high:.3f}"


if __name__ == "__main__":
    main(sys.argv[1:])
