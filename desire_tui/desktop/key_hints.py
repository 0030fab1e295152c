"""The keys that the status row names."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.commands import BY_ID
from desire_tui.common.key_names import key_name
from desire_tui.panes.status_bar import KeyHint

if TYPE_CHECKING:
    from collections.abc import Mapping

SHOWN_KEYS = {
    "run.start": "run",
    "run.accept": "OK",
    "run.pause": "pause",
    "view.palette": "palette",
    "help.word": "help",
    "view.next_pane": "next pane",
    "view.quantities": "quantities",
    "graph.full": "graph",
    "view.maximize": "zoom",
    "edit.next_problem": "problem",
    "file.save": "save",
    "file.quit": "quit",
}
"""Keys of the status row, the most wanted first, with a word for each."""


def key_hints(keys: Mapping[str, str]) -> list[KeyHint]:
    """Return the hints; `keys`: those that the user changed, by command id."""

    def first(command_id: str) -> str:
        every = keys.get(command_id) or BY_ID[command_id].keys
        return key_name(every.split(",")[0]).replace("Ctrl+", "^")

    return [KeyHint(first(command_id), word, command_id) for command_id, word in SHOWN_KEYS.items()]
