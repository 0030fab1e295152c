"""`make mutants`: put each deliberate fault of the table into a copy of the tree and see whether a test fails.

    python -m tests.mutants [--jobs N] [--first] [words of the faults wanted …]

The tests that should see a fault are run first, then all others of its room (`anchors.ROOM_TESTS`). What survives
them is a place that no test guards; all survivors are listed at the end.
"""

from __future__ import annotations

import argparse
import compileall
import os
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from tests.mutants.anchors import ROOT, place_of, with_fault
from tests.mutants.table import MUTANTS

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from tests.mutants.anchors import Mutant

SECONDS_MOST = 400
"""A fault that makes a loop endless is seen too."""
_COPIED = ("desire_tui", "tests", "examples", "docs", "pyproject.toml", "README.md", "CHANGELOG.md")
_NO_TESTS = {4, 5}
"""What pytest returns when it was called in vain."""
_GOOD = 0


@dataclass(frozen=True)
class Result:
    """What became of a fault; `seen` names the tests that failed, "" for none."""

    mutant: Mutant
    seen: str
    seconds: float


class Trees:
    """Copies of the tree, one for each thread."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._own = threading.local()

    def mine(self) -> Path:
        """Return this thread's copy."""
        if not hasattr(self._own, "tree"):
            tree = Path(tempfile.mkdtemp(dir=self._folder))
            for name in _COPIED:
                source = ROOT / name
                if source.is_dir():
                    shutil.copytree(source, tree / name, ignore=shutil.ignore_patterns("__pycache__"))
                else:
                    shutil.copy(source, tree / name)
            compileall.compile_dir(tree, quiet=1)
            self._own.tree = tree
        made: Path = self._own.tree
        return made


def run_tests(tree: Path, targets: Sequence[str]) -> str:
    """Run tests in a copy of the tree until one fails; return its name, "" if none does."""
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", *targets]
    # byte code of a file that was changed twice within a second would not be renewed
    environment = os.environ | {"PYTHONPATH": str(tree), "PYTHONDONTWRITEBYTECODE": "1"}
    try:
        ran = subprocess.run(
            command,
            cwd=tree,
            env=environment,
            capture_output=True,
            text=True,
            timeout=SECONDS_MOST,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return "the time limit"
    if ran.returncode == _GOOD:
        return ""
    if ran.returncode in _NO_TESTS:
        raise SystemExit(f"{targets}: {ran.stdout}{ran.stderr}")
    failed = [
        line.split(" ")[1] for line in ran.stdout.splitlines() if line.startswith(("FAILED ", "ERROR "))
    ]
    return failed[0] if failed else f"pytest's end with {ran.returncode}"


def try_mutant(mutant: Mutant, trees: Trees, *, first: bool) -> Result:
    """Put a fault in, run tests until one fails, take it out again."""
    began = time.perf_counter()
    tree = trees.mine()
    path, text = with_fault(mutant, tree)
    sound = path.read_text(encoding="utf-8")
    path.write_text(text, encoding="utf-8")
    try:
        seen = run_tests(tree, mutant.first if first and mutant.first else mutant.tests)
    finally:
        path.write_text(sound, encoding="utf-8")
    return Result(mutant, seen, time.perf_counter() - began)


def results(wanted: Sequence[Mutant], jobs: int, *, first: bool) -> Iterator[Result]:
    """Try faults, several at a time."""
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(jobs) as pool:
        trees = Trees(Path(folder))
        yield from pool.map(lambda mutant: try_mutant(mutant, trees, first=first), wanted)


def report(line: str) -> None:
    """Show a line at once, in a pipe too."""
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


def main() -> None:
    """Report each fault as it has been tried, then the score."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("words", nargs="*", help="only faults whose titles hold one of these words")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument(
        "--first", action="store_true", help="only the tests that should see a fault, not its room's"
    )
    options = parser.parse_args()
    words = options.words
    wanted = [m for m in MUTANTS if not words or any(word in m.title for word in words)]
    for mutant in wanted:
        place_of(mutant)  # a table that does not fit any more is told now
    began = time.perf_counter()
    survivors = []
    for number, result in enumerate(results(wanted, options.jobs, first=options.first), 1):
        how = f"seen by {result.seen}" if result.seen else "SURVIVED"
        report(f"{number:3} {result.seconds:5.0f} s  {result.mutant.title}\n{'':12}{how}")
        if not result.seen:
            survivors.append(result.mutant)
    killed = len(wanted) - len(survivors)
    seconds = time.perf_counter() - began
    share = 100 * killed / max(len(wanted), 1)
    report(f"\n{killed} of {len(wanted)} faults seen ({share:.0f} %) in {seconds:.0f} s")
    for mutant in survivors:
        report(f"survived: {mutant.title}")


if __name__ == "__main__":
    main()
