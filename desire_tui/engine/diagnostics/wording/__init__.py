"""The sentences, one module for each stage that can complain.

A key such as `undefined-variable` names a message; several keys may share one of Desire's error numbers.
`message` and `hint` are templates over the diagnostic's facts; `explanation` is the help page's text
(Markdown).
"""

from __future__ import annotations

from functools import cache
from importlib import import_module

from desire_tui.engine.diagnostics.wording.entry import Wording

STAGES = ("syntax", "analysis", "script", "run", "solvers", "system", "studies", "analyses", "conversion")


@cache
def all_wordings() -> dict[str, Wording]:
    """Every key with its wording, all stages together."""
    table: dict[str, Wording] = {}
    for stage in STAGES:
        messages: dict[str, Wording] = import_module(f"{__name__}.{stage}").MESSAGES
        twice = table.keys() & messages.keys()
        assert not twice, f"worded twice: {sorted(twice)}"
        table.update(messages)
    return table


def wording_of(key: str) -> Wording:
    """Return the wording of a key; raises KeyError for a key nobody worded (a programmer's mistake)."""
    return all_wordings()[key]


__all__ = ["STAGES", "Wording", "all_wordings", "wording_of"]
