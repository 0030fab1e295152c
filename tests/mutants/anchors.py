"""Deliberate faults and the places where they go in: found by text, not by line, and in a room, not a file."""

from __future__ import annotations

import keyword
import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

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


_NAME = re.compile(r"\b[A-Za-z_]\w*")


@dataclass(frozen=True)
class Mutant:
    """A fault: `old` becomes `new` in one file of the folder `room`; the tests in `first` should see it.

    `old` must stand exactly once in all of the room, so files may be moved. Line breaks and indentation in it are
    of no account, so that a formatter may change them. Names that were changed in the code are found again by what
    stands around them, if at least half of the names are still the same.
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
    """Where a fault goes in: a file below the root, a stretch of its text, and what is to stand there instead."""

    path: Path
    start: int
    end: int
    fault: str


def place_of(mutant: Mutant, root: Path = ROOT) -> Place:
    """Find where a fault goes in. AnchorError: nowhere, or at several places."""
    names = [name for name in dict.fromkeys(_NAME.findall(mutant.old)) if not keyword.iskeyword(name)]
    exact = _places(mutant, root, [])
    found = exact or _places(mutant, root, names)
    if len(found) == 1:
        return found[0]
    shown = ", ".join(str(place.path) for place in found) or "nowhere"
    raise AnchorError(f"{mutant.room}: {mutant.old!r} should stand once, but stands in: {shown}")


def _places(mutant: Mutant, root: Path, free: Sequence[str]) -> list[Place]:
    """Return where `old` stands; names in `free` may be others now, the same one at all their places."""
    pattern = _pattern(mutant.old, free)
    found = []
    for path, text in _texts(root / ENGINE / mutant.room):
        for match in pattern.finditer(text):
            now = {name: match[f"n{number}"] for number, name in enumerate(free)}
            if 2 * sum(now[name] == name for name in free) >= len(free):
                fault = _NAME.sub(lambda name, now=now: now.get(name[0], name[0]), mutant.new)  # type: ignore[misc]
                found.append(Place(path.relative_to(root), *match.span(), fault))
    return found


@cache
def _texts(folder: Path) -> list[tuple[Path, str]]:
    return [(path, path.read_text(encoding="utf-8")) for path in sorted(folder.rglob("*.py"))]


def _pattern(old: str, free: Sequence[str]) -> re.Pattern[str]:
    """Return what finds `old` with any white space and with other names for those that are free."""
    known: set[str] = set()

    def place(match: re.Match[str]) -> str:
        name = match[0]
        if name not in free:
            return name
        group = f"n{free.index(name)}"
        if name in known:
            return f"(?P={group})"
        known.add(name)
        return rf"(?P<{group}>\b[A-Za-z_]\w*\b)"

    words = (
        re.sub(r"[A-Za-z_]\w*|[^A-Za-z_]+", lambda part: _escaped(part, place), word) for word in old.split()
    )
    return re.compile(r"\s+".join(words))


def _escaped(part: re.Match[str], place: Callable[[re.Match[str]], str]) -> str:
    return place(part) if _NAME.fullmatch(part[0]) else re.escape(part[0])


def with_fault(mutant: Mutant, root: Path) -> tuple[Path, str]:
    """Return the file that a fault changes, and its text with the fault."""
    place = place_of(mutant, root)
    path = root / place.path
    text = path.read_text(encoding="utf-8")
    return path, text[: place.start] + place.fault + text[place.end :]


def program(*names: str) -> tuple[str, ...]:
    """Return the tests of some programs, named as `dynamic/mm`."""
    return tuple(f"{PROGRAMS}[tests/programs/{name}.src]" for name in names)
