"""`python -m tests.soak SECONDS`: edits, checks, runs and drops sessions; prints what the process holds."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path
from time import monotonic

from tests.soak.resources import Resources, most, resources
from tests.soak.work import Work

REPORT_SECONDS = 60
MEMORY_GROWTH_MB = 50
ROUNDS_TO_WARM = 30


def main(seconds: float) -> int:
    """Work for so long; 1 if the process ends with more than the most it had while everything was done a few times.

    The most: a thread that comes and goes with the work is there at the end or not.
    """
    with tempfile.TemporaryDirectory(prefix="desire-soak-") as folder:
        tempfile.tempdir = folder
        work = Work(Path(folder))
        began = monotonic()
        _report("start", 0, work, resources())
        first = resources()
        for _ in range(ROUNDS_TO_WARM):
            work.round()
            work.tidy()
            first = most(first, resources())
        _report("warm", monotonic() - began, work, first)
        due = monotonic() + REPORT_SECONDS
        while monotonic() - began < seconds:
            work.round()
            if monotonic() >= due:
                work.tidy()
                _report("", monotonic() - began, work, resources())
                due += REPORT_SECONDS
        work.tidy()
        last = resources()
        _report("end", monotonic() - began, work, last)
        tempfile.tempdir = None
    grown = [
        name
        for name, before, after in zip(Resources._fields, first, last, strict=True)
        if after > before + (MEMORY_GROWTH_MB if name == "memory" else 0)
    ]
    sys.stdout.write("grown: " + ", ".join(grown) + "\n" if grown else "nothing has grown\n")
    return 1 if grown else 0


def _report(word: str, seconds: float, work: Work, now: Resources) -> None:
    sys.stdout.write(
        f"{word:6} {seconds:6.0f} s  {now.memory:7.1f} MB  {now.threads:3} threads  {now.open_files:3} files  "
        f"{now.exit_handlers:2} exit handlers  {now.temporary_files:4} temporary  {work.rounds:6} rounds  "
        f"{work.runs:9} runs  {work.checks:7} checks\n"
    )
    sys.stdout.flush()


if __name__ == "__main__":
    sys.exit(main(float(sys.argv[1]) if len(sys.argv) > 1 else REPORT_SECONDS))
