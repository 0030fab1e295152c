"""What a session reports to its front end, and what it asks."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.diagnostics import Diagnostic
    from desire_tui.engine.graph.model import Graph
    from desire_tui.engine.nodes.program import Placed, Program
    from desire_tui.engine.runtime.run_record import RunRecord
    from desire_tui.engine.session.permissions import PermissionRequest
    from desire_tui.engine.source import Source


@dataclass(frozen=True, slots=True)
class StoppedAt:
    """Where the script stands still: at a STOP or, `tracing`, before the next statement."""

    placed: Placed
    source: Source
    tracing: bool = False


class Listener:
    """Base class of front ends; override what you need.

    Everything is called **on the thread that called the session** and must be cheap (post a message and
    return), except `ask` and `permit`, which may wait for the user. To break a waiting `ask` off (the user
    pressed Ctrl-C, the app exits), raise `Interrupted` in it.
    """

    wants_check = True
    """Whether an accepted text is checked as a whole at once, for problems shown beside it."""

    def console_text(self, text: str) -> None:
        """Console output, exactly this text: lines may come in pieces."""

    def ask(self, prompt: str) -> str:
        """Return one line of console input. EOFError: there is no more."""
        raise EOFError(prompt)

    def permit(self, request: PermissionRequest) -> bool:
        """Whether the program may do this (a shell command, a file outside its folder)."""
        del request
        return False

    def program_accepted(self, program: Program, problems: Sequence[Diagnostic]) -> None:
        """Note that a text became the active program; `problems` are what parser and check say about it."""

    def run_started(self, record: RunRecord) -> None:
        """Note that a run begins; its record grows from now on. `session.graph` already shows its frame."""

    def run_ended(self, record: RunRecord) -> None:
        """Note that the run ended: `record.ended` and `record.message` say why."""

    def problems(self, diagnostics: Sequence[Diagnostic]) -> None:
        """Problems that do not stop the script (warnings). What stops it is raised as DesireError instead."""

    def stopped_at(self, place: StoppedAt) -> None:
        """Note that the script stopped; `go` continues."""

    def graph_changed(self, graph: Graph) -> None:
        """Redraw: another graph, an erased one, a point, a curve. Samples of a run come without a call."""

    def quantities_cleared(self) -> None:
        """All names were cleared (`erun`, `clear`, `new`)."""

    def noted(self, text: str) -> None:
        """Note that a line went into the notebook."""

    def line_wanted(self, row: int) -> None:
        """Bring a row of the active program into view (from 1): the script came to `edit 210-240`."""

    def front_source(self) -> Source | None:
        """Return the text of the editor in front: what `erun` takes. None: run the active program again."""
        return None

    def command(self, word: str, argument: str | None) -> bool:
        """Carry out a command about editors and the app: `ed edit keep keep+ reload load new NEW bye help`.

        Returns False where the front end has no such thing; the session then says so (error 402).
        """
        del word, argument
        return False
