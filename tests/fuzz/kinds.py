"""The kinds of inputs: a new one is a module with `generate(rng)` and `check(input)`, and a row here."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from random import Random
from typing import Any

Input = str | list[str]


@dataclass(frozen=True)
class Kind:
    """One kind. `share`: of the time in `make fuzz`; `in_suite`: inputs that the test suite tries."""

    name: str
    about: str
    seconds_most: float
    """An input that takes longer is a failure."""
    share: float
    in_suite: int
    renewed_after: int = 20_000
    """A process makes so many inputs, then another takes over: what one keeps is not this fuzzer's subject."""

    @property
    def module(self) -> Any:
        """Import the module that makes and checks the inputs."""
        return import_module(f"tests.fuzz.{self.name}")

    def generate(self, seed: int, number: int) -> Input:
        """Return an input, always the same for the same seed and number."""
        made: Input = self.module.generate(self.random(seed, number))
        return made

    def random(self, seed: int, number: int) -> Random:
        """Return the generator that an input is made with."""
        return Random(f"{self.name}:{seed}:{number}")


_ALL = (
    Kind("back_ends", "programs by grammar, native code against NumPy", 30, 4, 24, 400),
    Kind("lanes", "models of scalars, runs in lock step against runs made alone", 30, 1, 6, 300),
    Kind("texts", "damaged texts: parser, checker, colours, completion", 10, 4, 1500),
    Kind("runs", "damaged programs run into every output", 20, 3, 30, 400),
    Kind("commands", "command lines", 30, 2, 15, 300),
    Kind("settings", "values given from outside", 20, 1, 40, 1000),
    Kind("editor", "edits, undo and redo in panes of 1 to 40 rows, one text in two views", 120, 2, 1, 100),
    Kind("signals", "signals at random moments to `desire run`", 300, 2, 3),
    Kind("kills", "kill -9 to the desktop while somebody types, saves and runs", 120, 2, 1),
    Kind("terminal", "keys, mouse and resizes to the desktop", 120, 3, 1, 30),
)
KINDS: dict[str, Kind] = {kind.name: kind for kind in _ALL}
