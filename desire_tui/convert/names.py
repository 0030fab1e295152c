"""What the quantities of a model are called in a Desire program."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from desire_tui.engine.syntax.reserved import RESERVED

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from desire_tui.convert.model import Model

_LEGAL = re.compile(r"[A-Za-z](?:\w*[A-Za-z0-9])?\Z", re.ASCII)


class NameTable:
    """Names of a model with those that they have in the program.

    Calling it with a name of the model returns the program's; names that are none of the model's (the time,
    the library's functions) are returned as they are. `renamed` has those that differ.
    """

    def __init__(self, names: Iterable[str]) -> None:
        self._taken = set(RESERVED)
        self._given: dict[str, str] = {}
        self._beside: dict[str, str] = {}
        every = list(dict.fromkeys(names))
        for name in every:
            if name not in RESERVED and _LEGAL.match(name):
                self._given[name] = name
                self._taken.add(name)
        for name in every:
            if name not in self._given:
                self._given[name] = self.fresh(_spelled(name))
        self.renamed = {old: new for old, new in self._given.items() if old != new}

    def __call__(self, name: str) -> str:
        """Return the program's name for one of the model's; Desire's own stand in angle brackets."""
        if name.startswith("<"):
            return name[1:-1]
        return self._given.get(name, name)

    def beside(self, wanted: str) -> str:
        """Return the name of something that belongs to a quantity: the same each time it is asked for."""
        if wanted not in self._beside:
            self._beside[wanted] = self.fresh(wanted)
        return self._beside[wanted]

    def fresh(self, wanted: str) -> str:
        """Return a name that nothing else has: `wanted`, or that with a number behind it."""
        name, count = wanted, 0
        while name in self._taken:
            count += 1
            name = f"{wanted}_{count}"
        self._taken.add(name)
        return name


def _spelled(name: str) -> str:
    """Return a name of letters, digits and underscores that begins with a letter and does not end in `_`."""
    plain = re.sub(r"\W+", "_", name, flags=re.ASCII).strip("_") or "q"
    return plain if plain[0].isalpha() else f"q{plain}"


def names_of(model: Model) -> Iterator[str]:
    """Yield the names that a model declares, in the order of the program."""
    for group in (model.functions, model.parameters, model.tables, model.held, model.markov, model.noises,
                  model.variables, model.states, model.shown, model.presets):  # fmt: skip
        for one in group:
            yield one.name
