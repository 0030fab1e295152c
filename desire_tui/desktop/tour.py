"""The first start: a few sentences at the right moments, then never again."""

from __future__ import annotations

import contextlib
from typing import TYPE_CHECKING

from desire_tui.common.paths import state_folder
from desire_tui.engine.user_folders import make_private

if TYPE_CHECKING:
    from pathlib import Path

    from desire_tui.app import DesireApp

WELCOME = """\
Welcome to Desire. A program is loaded.
Press F5 (or type zz and Enter) to run it."""
NEXT = (
    "That was a run. Change a number in the program, press F5 again.",
    "Ctrl+C pauses a run, Enter goes on, Space Enter ends it. F7 shows the graph alone.",
    "F1 explains the word at the cursor, Ctrl+P lists all actions, F11 the examples. Have fun.",
)


class Tour:
    """Speaks in the command pane."""

    def __init__(self, app: DesireApp) -> None:
        self._app = app
        self._next: list[str] = []
        self._ran = False

    @property
    def was_taken(self) -> bool:
        """Whether the tour began once on this machine."""
        return _mark().exists()

    def begin(self) -> None:
        """Start the tour, and remember that."""
        with contextlib.suppress(OSError):  # a state folder that cannot be written: the tour comes again
            make_private(str(_mark().parent))
            _mark().touch()
        self._next = list(NEXT)
        self._app.command.console.add(WELCOME, "notice")

    def run_ended(self) -> None:
        """Remember that there was something to see."""
        self._ran = True

    def program_ended(self) -> None:
        """Say the next sentence after a program that made runs."""
        if self._ran and self._next:
            self._app.command.console.add(self._next.pop(0), "notice")
        self._ran = False


def _mark() -> Path:
    return state_folder() / "tour-taken"
