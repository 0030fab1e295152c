"""Deliberate faults and the places where they go in: found by text, not by line, and in a room, not a file."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
ENGINE = Path("desire_tui/engine")
PROGRAMS = "tests/programs/test_programs.py::test_program"
"""Every program with its expectations, on both back ends."""

ROOM_TESTS = {
    ".": ("tests/codegen/test_random.py", "tests/interpreter/test_library.py", PROGRAMS),
    "lowering": ("tests/lowering", "tests/check/test_problems.py", "tests/passes", PROGRAMS),
    "lowered": ("tests/passes", "tests/lowering", PROGRAMS),
    "passes": ("tests/passes", "tests/reference/test_jacobian_check.py", PROGRAMS, "tests/integration/test_stiff_runs.py"),
    "codegen": (PROGRAMS, "tests/codegen", "tests/numerics", "tests/integration"),
    "reference": (PROGRAMS, "tests/reference", "tests/integration/test_both_back_ends.py"),
    "runtime": (PROGRAMS, "tests/runtime"),
    "integration": ("tests/integration", PROGRAMS),
    "interpreter": ("tests/interpreter", PROGRAMS),
    "check": ("tests/check/test_problems.py", PROGRAMS),
    "structure": ("tests/structure", "tests/interpreter/test_script_programs.py", PROGRAMS),
}  # fmt: skip
"""The tests that guard a room; what survives them is taken to survive all."""


@dataclass(frozen=True)
class Mutant:
    """A fault: `old` becomes `new` in one file of the folder `room`; the tests in `first` should see it.

    `old` must stand exactly once in all of the room. Line breaks and indentation in it are of no account, so that
    a formatter may change them; names are, so it should hold as few as it can.
    """

    room: str
    old: str
    new: str
    first: tuple[str, ...] = ()

    @property
    def tests(self) -> tuple[str, ...]:
        """The tests to run, in this order."""
        return (*self.first, *ROOM_TESTS[self.room.split("/")[0]])

    @property
    def title(self) -> str:
        """What a report calls it."""
        return f"{self.room}: {' '.join(self.old.split())} → {' '.join(self.new.split())}"


class AnchorError(Exception):
    """A fault's place is not there any more, or is not the only one: the table must follow the code."""


@dataclass(frozen=True)
class Place:
    """Where a fault goes in: a file below the root, and what stands there now."""

    path: Path
    start: int
    end: int


def place_of(mutant: Mutant, root: Path = ROOT) -> Place:
    """Find where a fault goes in. AnchorError: nowhere, or at several places."""
    pattern = re.compile(r"\s+".join(re.escape(word) for word in mutant.old.split()))
    found = []
    for path in sorted((root / ENGINE / mutant.room).rglob("*.py")):
        text = path.read_text(encoding="utf-8")
        found += [Place(path.relative_to(root), *match.span()) for match in pattern.finditer(text)]
    if len(found) == 1:
        return found[0]
    shown = ", ".join(str(place.path) for place in found) or "nowhere"
    raise AnchorError(f"{mutant.room}: {mutant.old!r} should stand once, but stands in: {shown}")


def with_fault(mutant: Mutant, root: Path) -> tuple[Path, str]:
    """Return the file that a fault changes, and its text with the fault."""
    place = place_of(mutant, root)
    path = root / place.path
    text = path.read_text(encoding="utf-8")
    return path, text[: place.start] + mutant.new + text[place.end :]


def program(*names: str) -> tuple[str, ...]:
    """Return the tests of some programs, named as `dynamic/mm`."""
    return tuple(f"{PROGRAMS}[tests/programs/{name}.src]" for name in names)
