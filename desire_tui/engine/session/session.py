"""The session: what a user of the engine holds in his hand."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Literal

from desire_tui.engine.session.permissions import Permissions
from desire_tui.engine.session.status import State, Status

if TYPE_CHECKING:
    from desire_tui.engine.diagnostics import Diagnostic
    from desire_tui.engine.graph import Graph, GraphBook
    from desire_tui.engine.nodes import Program
    from desire_tui.engine.runtime.record import RunRecord
    from desire_tui.engine.session.listener import Listener, StoppedAt
    from desire_tui.engine.source import Source
    from desire_tui.engine.values import Values

BackendName = Literal["native", "reference"]


class Session:
    """Programs, quantities, runs and graphs of one user.

    Threads: `accept erun run go execute snapshot` belong to one thread (the app's engine thread) and return
    when the work is done; they raise DesireError with placed diagnostics when something fails, error 301 when
    the user ended it. `pause resume end check status` may be called from any thread at any time. `values` may
    be read from any thread; numbers change while a run goes on.
    """

    values: Values
    """All quantities by name and their numbers."""
    program: Program | None
    """The active program, as accepted last."""
    runs: list[RunRecord]
    """The runs since the program started, oldest first; old ones go when they fill the memory allowed."""
    graphs: GraphBook
    """The last graphs, oldest first; `graph` is the newest."""
    rule: int
    """`irule`; 1 if never set."""
    folder: Path
    """Relative file names of scripts start here; the program's own folder once it has a path."""
    permissions: Permissions

    def __init__(
        self,
        console: Listener | None = None,
        *,
        backend: BackendName = "native",
        folder: Path | None = None,
        permissions: Permissions | None = None,
    ) -> None: ...

    # ------------------------------------------------------------------ the program

    def accept(self, source: Source) -> tuple[Diagnostic, ...]:
        """Make `source` the active program (the OK button). Returns its problems; none of them is raised.

        A script that stopped at STOP cannot go on afterwards (error 43).
        """

    def check(self, source: Source) -> tuple[Diagnostic, ...]:
        """Return all problems of a text (parser, structure, static check) without touching the session."""

    def new(self) -> None:
        """Forget the program and all quantities; scale 1, irule 1 (`NEW`)."""

    # ------------------------------------------------------------------ running

    def erun(self, source: Source | None = None) -> None:
        """Accept `source` (default: the editor in front, else the active program), clear all names, run."""

    def run(self) -> None:
        """Run the active program's script again from the top, keeping irule and scale."""

    def go(self) -> None:
        """Continue after STOP; error 43 if there is nothing to continue or the program was edited."""

    def execute(self, text: str) -> None:
        """Carry out one command line; an empty line does nothing."""

    # ------------------------------------------------------------------ steering, from any thread

    def pause(self) -> None:
        """Hold the run or the script within 0.1 s; nothing happens when idle."""

    def resume(self) -> None:
        """Go on after `pause`."""

    def end(self) -> None:
        """End the run and the script; the samples stay. The waiting call raises error 301."""

    @property
    def status(self) -> Status:
        """What is going on now."""

    @property
    def stopped_at(self) -> StoppedAt | None:
        """Where the script stopped, if `go` can continue it."""

    @property
    def graph(self) -> Graph | None:
        """The newest graph."""

    # ------------------------------------------------------------------ results

    def snapshot(self, path: Path, graph: Graph | None = None) -> Path:
        """Write a graph (default: the newest) as PNG, SVG or PDF by the path's ending; returns the path.

        DesireError 106 where it cannot be written, 460 without a graph. Safe from any thread.
        """

    def help(self, topic: str = "") -> str:
        """Return the help page (Markdown) of a statement, function, command or error number."""
