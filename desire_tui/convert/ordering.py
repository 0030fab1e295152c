"""In which order quantities can be computed that depend on each other."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.convert.expressions import functions_in, names_in

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from desire_tui.convert.expressions import Expression
    from desire_tui.convert.model import Function


class CircularError(Exception):
    """Quantities that wait for each other: `names`, in the order in which each waits for the next."""

    def __init__(self, names: list[str]) -> None:
        super().__init__(" → ".join(names))
        self.names = names


def needed_by(expression: Expression, functions: Mapping[str, Function]) -> set[str]:
    """Return the quantities and tables that it needs, those that functions read included."""
    found = names_in(expression)
    seen: set[str] = set()
    rest = functions_in(expression)
    while rest:
        name = rest.pop()
        if name in seen:
            continue
        seen.add(name)
        if name in functions:
            function = functions[name]
            found |= names_in(function.body) - set(function.dummies)
            rest |= functions_in(function.body)
    return found


def in_order(needs: Mapping[str, set[str]]) -> list[str]:
    """Return the names so that each stands behind those it needs, else in the order given. CircularError.

    What is needed and has no entry of its own is there already.
    """
    position = {name: place for place, name in enumerate(needs)}

    def waiting_for(name: str) -> Iterator[str]:
        return iter(sorted(needs[name] & position.keys(), key=position.__getitem__))

    done: dict[str, None] = {}
    for first in needs:
        path = {} if first in done else {first: waiting_for(first)}
        while path:
            name, others = next(reversed(path.items()))
            other = next((one for one in others if one not in done), None)
            if other is None:
                done[name] = None
                del path[name]
            elif other in path:
                waiting = list(path)
                raise CircularError([*waiting[waiting.index(other) :], other])
            else:
                path[other] = waiting_for(other)
    return list(done)
