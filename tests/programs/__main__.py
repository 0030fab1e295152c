"""`python -m tests.programs FILE…`: what is not as the programs' comments say, and how long each took."""

from __future__ import annotations

import sys
import tempfile
import time
import traceback
from pathlib import Path

from tests.programs.runner import faults_of_program


def main(names: list[str]) -> int:
    """Check the named programs; returns how many had faults."""
    bad = 0
    for name in names:
        began = time.perf_counter()
        try:
            with tempfile.TemporaryDirectory() as folder:
                faults = faults_of_program(Path(name).read_text(encoding="utf-8"), Path(folder))
        except Exception:  # noqa: BLE001 - a fault of the engine; the next program still gets its turn
            faults = ["".join(traceback.format_exc(limit=-3))]
        head = f"{'BAD ' if faults else 'ok  '} {time.perf_counter() - began:6.2f} s  {name}"
        sys.stdout.write("\n    ".join([head, *faults]) + "\n")
        bad += bool(faults)
    return bad


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]) > 0)
