"""How many lines a segment has once its submodels are expanded, found without expanding them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.nodes.names import invocation

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from desire_tui.engine.nodes.program import Placed
    from desire_tui.engine.structure.outline import SubmodelText

LINES_MOST = 1_000_000
"""Statements that a segment may have when its submodels are expanded."""


def expanded_lines(submodels: Mapping[str, SubmodelText]) -> dict[str, int]:
    """Return the lines of each submodel's body, and of the bodies invoked there, with the invocations.

    Each body is looked at once. Submodels that invoke themselves are errors elsewhere: inner ones count 0.
    """
    plain: dict[str, int] = {}
    invoked: dict[str, list[str]] = {}
    for name, submodel in submodels.items():
        invoked[name] = [inner for inner in _invoked(submodel.body) if inner in submodels]
        plain[name] = len(submodel.body)
    lines: dict[str, int] = {}
    opened: set[str] = set()
    for root in submodels:
        waiting = [root]
        while waiting:
            name = waiting[-1]
            inner = [] if name in opened else [n for n in invoked[name] if n not in opened]
            opened.add(name)
            if inner:
                waiting += inner
                continue
            waiting.pop()
            if name not in lines:
                total = plain[name] + sum(lines.get(n, 0) for n in invoked[name])
                lines[name] = min(total, LINES_MOST + 1)  # sums of sums would become very long numbers
    return lines


def _invoked(body: Iterable[Placed]) -> Iterable[str]:
    for placed in body:
        found = invocation(placed.node)
        if found is not None:
            yield found[0]
