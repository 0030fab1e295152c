"""`make fuzz`: random inputs of every kind, for a time or a count; all failures are listed at the end.

    python -m tests.fuzz [KIND …] [--seconds N] [--count N] [--seed S] [--first N] [--failures FOLDER]
    python -m tests.fuzz KIND --again FILE      # try a kept input once more

An input depends on its kind, the seed and its number only. Of each fault the smallest input found is kept in
the folder. The exit status is 1 if anything failed.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

from tests.fuzz.kinds import KINDS, Input, Kind
from tests.fuzz.minimise import minimised
from tests.fuzz.runner import Report, SingleInputs, try_kind

MINIMISING_SECONDS = 30.0


def main() -> int:
    """Report each kind as it has been tried, then its faults."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("kinds", nargs="*", metavar="KIND", help=", ".join(KINDS))
    parser.add_argument("--seconds", type=float, default=60.0, help="for all kinds together")
    parser.add_argument("--count", type=int, help="so many inputs of each kind instead")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="number of the first input")
    parser.add_argument("--failures", type=Path, default=Path("fuzz-failures"))
    parser.add_argument("--again", type=Path, help="a kept input")
    options = parser.parse_args()
    kinds = [KINDS[name] for name in options.kinds or KINDS]
    if options.again is not None:
        return _again(kinds[0], options.again)
    shares = sum(kind.share for kind in kinds)
    failed = 0
    for kind in kinds:
        seconds = float("inf") if options.count is not None else options.seconds * kind.share / shares
        report = try_kind(kind, options.seed, first=options.first, count=options.count, seconds=seconds)
        rate = report.tried / max(report.seconds, 1e-9)
        show(
            f"{kind.name:10} {report.tried:9,} inputs in {report.seconds:5.0f} s ({rate:6,.0f}/s), "
            f"{report.failed} failed: {kind.about}"
        )
        for signature in report.faults:
            show(_kept(report, signature, options.seed, options.failures))
        failed += report.failed
    return 1 if failed else 0


def _kept(report: Report, signature: str, seed: int, folder: Path) -> str:
    """Keep the smallest input of a fault; return what to show."""
    kind = report.kind
    number, fault = report.faults[signature]
    made = kind.generate(seed, number)
    tester = SingleInputs(kind, kind.seconds_most)

    def fails(smaller: Input) -> bool:
        found = tester.fault(smaller)
        return found is not None and found.signature == signature

    again = fails(made)
    if again:
        made = minimised(made, fails, MINIMISING_SECONDS)
    tester.close()
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{kind.name}-{seed}-{number}.json"
    path.write_text(json.dumps(made, indent=1) + "\n", "utf-8")
    path.with_suffix(".log").write_text(f"{fault.signature}\n\n{fault.detail}\n", "utf-8")
    alone = "" if again else "; not when tried alone"
    return f"  {kind.name}, seed {seed}, number {number}: {signature}{alone}\n    kept in {path}"


def _again(kind: Kind, path: Path) -> int:
    tester = SingleInputs(kind, kind.seconds_most)
    fault = tester.fault(json.loads(path.read_text("utf-8")))
    tester.close()
    show(f"{fault.signature}\n{fault.detail}" if fault else "no failure")
    return 1 if fault else 0


def show(line: str) -> None:
    """Show a line at once, in a pipe too."""
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    sys.exit(main())
