"""The example programs in the order of the book: names, what each shows, a search over them."""

from __future__ import annotations

import re
from functools import cached_property
from typing import TYPE_CHECKING

from desire_tui.common.paths import examples_folder
from desire_tui.engine.data_classes import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

CHAPTERS = {
    "ch1": "First steps: runs, samples, integration rules",
    "ch2": "Oscillators, reactors, flight, orbits, populations",
    "ch3": "Control, parameter studies, difference equations, sampled data",
    "ch4": "Functions, noise, limiters, hysteresis, relays, submodels",
    "ch5": "The script: control flow, procedures, arrays, files, console",
    "ch6": "Vectors and matrices, filters, Monte Carlo studies, partial differential equations, delays",
    "ch7": "Benchmarks, models with events, physiology, system dynamics",
    "ch8": "Fast plots, statistics, complex numbers, Fourier transforms",
    "appendix": "Integration errors and stiff systems",
    "stability": "Steady states, phase planes, bifurcations",
    "networks": "Neural networks and fuzzy logic",
}
"""Folder → what its programs are about, in reading order."""

_ANSWERS = re.compile(r"^--\? answers (.*)$", re.MULTILINE)
_EXPECTED_HEAD = "-- What it must show"
_EXPECTED = re.compile(r"^--[?|].*$\n?", re.MULTILINE)


@dataclass(frozen=True)
class Example:
    """A program of the examples folder."""

    path: Path
    text: str

    @property
    def name(self) -> str:
        """What it is called: `step_response`."""
        return self.path.stem

    @property
    def folder(self) -> str:
        """Where it stands: `ch1`."""
        return self.path.parent.name

    @property
    def chapter(self) -> str:
        """`Chapter 1`, `Appendix`; the folder's own name for one that is not the book's."""
        number = re.fullmatch(r"ch(\d+)", self.folder)
        return f"Chapter {number[1]}" if number else self.folder.capitalize()

    @property
    def subject(self) -> str:
        """What its chapter is about; empty for a folder of one's own."""
        return CHAPTERS.get(self.folder, "")

    @cached_property
    def about(self) -> str:
        """What the program says about itself: the comment lines at its top, as one text."""
        lines = []
        for line in self.text.splitlines():
            if not line.startswith("-- "):
                break
            lines.append(line[3:].strip())
        return " ".join(lines)

    @cached_property
    def body(self) -> str:
        """The program without the description at its top and without what tests expect of it."""
        lines = _EXPECTED.sub("", self.text).splitlines()
        first = next((n for n, line in enumerate(lines) if line.strip() and not line.startswith("-- ")), 0)
        kept = [line for line in lines[first:] if not line.startswith(_EXPECTED_HEAD)]
        return "\n".join(kept).rstrip()

    @property
    def answers(self) -> list[str]:
        """What the program's `--? answers` line types where it asks."""
        found = _ANSWERS.search(self.text)
        return [answer.strip() for answer in found[1].split(" | ")] if found else []

    @cached_property
    def words(self) -> tuple[str, str, str]:
        """What a search looks through, the weightiest first: name; chapter and description; the program."""
        about = f"{self.chapter} {self.subject} {self.about}"
        program = _EXPECTED.sub("", self.text)
        return (
            f"{self.folder}/{self.name} {self.name.replace('_', ' ')}".casefold(),
            about.casefold(),
            program.casefold(),
        )


def examples(folder: Path | None = None) -> list[Example]:
    """Return every example: the chapters of the book, the appendix, further subjects; programs by name."""
    root = folder if folder is not None else examples_folder()
    order = {name: number for number, name in enumerate(CHAPTERS)}
    paths = sorted(
        root.glob("*/*.src"), key=lambda p: (order.get(p.parent.name, len(order)), p.parent.name, p.stem)
    )
    return [Example(path, path.read_text(encoding="utf-8", errors="replace")) for path in paths]


def search(text: str, among: Iterable[Example]) -> list[Example]:
    """Return the examples that hold every word of `text`: names first, then descriptions, then programs."""
    wanted = text.casefold().split()
    ranked = [(rank, example) for example in among if (rank := _rank(example, wanted)) is not None]
    return [example for _, example in sorted(ranked, key=lambda entry: entry[0])]


def _rank(example: Example, wanted: list[str]) -> int | None:
    worst = 0
    for word in wanted:
        rank = next((rank for rank, text in enumerate(example.words) if word in text), None)
        if rank is None:
            return None
        worst = max(worst, rank)
    return worst
