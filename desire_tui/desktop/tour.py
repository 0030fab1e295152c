"""The first start: a note that points at one pane after the other, then never again unasked."""

from __future__ import annotations

import contextlib
from typing import TYPE_CHECKING, NamedTuple

from desire_tui.common.paths import state_folder
from desire_tui.engine.user_folders import make_private

if TYPE_CHECKING:
    from pathlib import Path

    from desire_tui.app import DesireApp
    from desire_tui.desktop.layout_rules import Pane
    from desire_tui.desktop.tour_note import TourNote

WELCOME = """\
Welcome to Desire. A program is loaded.
Press F5 (or type zz and Enter) to run it."""


class Step(NamedTuple):
    """A pane, what is said there, and whether a run is what leads on."""

    pane: Pane
    title: str
    sentence: str
    leads_on: str = ""


STEPS = (
    Step("editor", "The program", "A program is loaded. F5 (or zz and Enter below) runs it.", "run"),
    Step("graph", "Its graph", "That was a run. Alt+R reads off values, F7 shows the graph alone."),
    Step("editor", "Your turn", "Change a number in the program, press F5 again.", "run"),
    Step(
        "command",
        "The command line",
        "What is typed here is carried out at once: write x. Ctrl+C pauses a run, Enter goes on, Space Enter "
        "ends it.",
    ),
    Step(
        "command",
        "Where to find more",
        "F1 explains the word at the cursor, Ctrl+P lists all actions, F11 the examples. Have fun.",
    ),
)


class Tour:
    """Points with a note; where there is no room for one it speaks in the command pane."""

    def __init__(self, app: DesireApp) -> None:
        self._app = app
        self._at: int | None = None
        self._ran = False
        self._note: TourNote | None = None

    @property
    def was_taken(self) -> bool:
        """Whether the tour began once on this machine."""
        return _mark().exists()

    def begin(self) -> None:
        """Start the tour, and remember that."""
        with contextlib.suppress(OSError):  # a state folder that cannot be written: the tour comes again
            make_private(str(_mark().parent))
            _mark().touch()
        self._app.command.console.add(WELCOME, "notice")
        self._go_to(0)

    def step(self) -> None:
        """Go to the next step; begin where no tour goes on."""
        self._go_to(0 if self._at is None else self._at + 1)

    def run_ended(self) -> None:
        """Remember that there was something to see."""
        self._ran = True

    def program_ended(self) -> None:
        """Go on after a program that made runs."""
        if self._ran and self._at is not None and STEPS[self._at].leads_on == "run":
            self._go_to(self._at + 1)
        self._ran = False

    def _go_to(self, number: int) -> None:
        self._at = number if number < len(STEPS) else None
        if self._note is not None:
            self._note.target.remove_class("-pointed")
            self._note.remove()
            self._note = None
        if self._at is None:
            return
        step = STEPS[self._at]
        from desire_tui.desktop.tour_note import TourNote, has_room

        if not has_room(self._app.size):
            if number:
                self._app.command.console.add(step.sentence, "notice")
            return
        self._note = TourNote(
            step.pane, step.title, step.sentence, f"{number + 1} of {len(STEPS)}", self.step
        )
        screen = self._app.main_screen
        screen.query_one(f"#{step.pane}").add_class("-pointed")
        screen.mount(self._note)


def _mark() -> Path:
    return state_folder() / "tour-taken"
