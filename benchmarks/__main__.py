"""Runs every benchmark, `bench_*.py`: `python -m benchmarks [name …]`."""

from __future__ import annotations

import runpy
import sys
from pathlib import Path


def main() -> None:
    """Run those whose name holds one of the arguments; all without arguments."""
    wanted = sys.argv[1:]
    sys.argv[1:] = []
    for path in sorted(Path(__file__).parent.glob("bench_*.py")):
        if not wanted or any(word in path.stem for word in wanted):
            print(f"\n== {path.stem}", flush=True)
            runpy.run_module(f"benchmarks.{path.stem}", run_name="__main__")


if __name__ == "__main__":
    main()
