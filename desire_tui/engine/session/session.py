"""A session: the engine as its users see it; one program at a time, its values, runs and graphs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.graph.pages import GraphPages
from desire_tui.engine.integration.rules import DEFAULT_RULE
from desire_tui.engine.runtime.pause_and_stop import Control
from desire_tui.engine.session.activity import Activity
from desire_tui.engine.session.console import Console
from desire_tui.engine.session.current_interpreter import CurrentInterpreter
from desire_tui.engine.session.listener import Listener
from desire_tui.engine.session.notebook import Notebook
from desire_tui.engine.session.permissions import Permissions
from desire_tui.engine.session.runs import Runs
from desire_tui.engine.session.script import ScriptRunner
from desire_tui.engine.session.script_host import ScriptHost
from desire_tui.engine.session.session_commands import SessionCommands
from desire_tui.engine.session.static_check import StaticChecker
from desire_tui.engine.session.status import State, Status
from desire_tui.engine.session.workspace import Workspace
from desire_tui.engine.source import Source
from desire_tui.engine.values import DT, SCALE, TMAX, T

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence
    from pathlib import Path

    from desire_tui.engine.codegen.compiler_state import CompilerState
    from desire_tui.engine.graph.model import Graph
    from desire_tui.engine.nodes.program import Placed, Program
    from desire_tui.engine.outputs.picture_options import PictureOptions
    from desire_tui.engine.runtime.run_record import RunRecord
    from desire_tui.engine.session.kept_expressions import KeptExpressions
    from desire_tui.engine.session.listener import StoppedAt
    from desire_tui.engine.session.prepared_run import PreparedRun
    from desire_tui.engine.session.quantity_plots import PlotOutcome
    from desire_tui.engine.values import Values

BackendName = Literal["native", "reference"]
CHECK_SECONDS = 3.0
"""For checking a text while somebody waits or types; 20,000 equations take half of it."""


class Session:
    """Programs, quantities, runs and graphs of one user.

    Threads: `accept erun run go execute new` belong to one thread (the app's engine thread) and return when
    the work is done; they raise DesireError with placed diagnostics when something fails, error 301 when the
    user ended it. `pause resume end evaluate_while_running check status snapshot help` may be called from
    any thread at any time. `values` may be read from any thread; numbers change while a run goes on.
    """

    def __init__(
        self,
        console: Listener | None = None,
        *,
        backend: BackendName = "native",
        folder: Path | None = None,
        permissions: Permissions | None = None,
        compiler: CompilerState | None = None,
        elements_most: int | None = None,
    ) -> None:
        self._listener = console if console is not None else Listener()
        self.control = Control()
        self._control = self.control
        self._activity = Activity(self._control)
        self._notebook = Notebook(lambda problem: self._listener.problems((problem,)), _draw)
        if permissions is None:
            permissions = Permissions()
        self._workspace = Workspace(backend, folder, permissions, self._notebook, compiler, elements_most)
        self.graphs = GraphPages()
        """The last graphs, oldest first; `graph` is the newest."""
        self._runs = Runs(self._workspace, self._listener, self._control, self.graphs)
        output = Console(self._listener, self._notebook)
        shared = (self._workspace, self._listener, output, self._activity, self._runs, self.graphs)
        self._commands = SessionCommands(self, *shared)
        current = CurrentInterpreter()
        self._host = ScriptHost(*shared, current, self._commands)
        self._script = ScriptRunner(
            self._workspace, self._listener, self._activity, self._runs, current, self._host
        )
        self._checker = StaticChecker()

    # ------------------------------------------------------------------ what there is

    @property
    def values(self) -> Values:
        """All quantities by name, and their numbers."""
        return self._workspace.values

    @property
    def program(self) -> Program | None:
        """The active program, as accepted last."""
        return self._workspace.program

    @property
    def faulty(self) -> tuple[Diagnostic, ...]:
        """Errors of the active program's text that stop it where they are reached, and nowhere else."""
        return self._workspace.faulty

    @property
    def runs(self) -> list[RunRecord]:
        """The runs since the program started, oldest first; old ones go when they fill the memory allowed."""
        return self._runs.kept

    @property
    def graph(self) -> Graph | None:
        """The newest graph."""
        return self.graphs.current

    @property
    def rule(self) -> int:
        """`irule`; 1 if never set."""
        return self._host.rule

    @property
    def folder(self) -> Path:
        """Where relative file names of scripts start: the program's folder once it has a path."""
        return self._workspace.folder

    @property
    def permissions(self) -> Permissions:
        """What programs may do; what the user granted is remembered here."""
        return self._workspace.permissions

    @property
    def parse_seconds(self) -> float:
        """Real time that reading the active program took."""
        return self._workspace.parse_seconds

    @property
    def stopped_at(self) -> StoppedAt | None:
        """Where the script stopped, if `go` can continue it."""
        return None if self._script.edited else self._script.stopped

    @property
    def status(self) -> Status:
        """What is going on now."""
        host, runs, cells = self._host, self._runs, self.values.cells
        record = next(reversed(runs.kept), None)  # the list may be emptied meanwhile
        memory = runs.simulator.memory
        state = self._activity.state
        if self._control.paused and state in (State.RUNNING, State.SCRIPT):
            state = State.PAUSED
        elif state is State.IDLE and self.stopped_at is not None:
            state = State.STOPPED
        steps = int(memory.steps) if memory is not None else record.steps if record else 0
        return Status(
            state=state, run=runs.count, segment=record.segment if record else None,
            t=runs.simulator.direction * cells[T],
            t0=record.t0 if record else 0.0, t_max=record.t_max if record else cells[TMAX], steps=steps,
            steps_per_second=runs.simulator.pace(steps, record), dt=cells[DT],
            rule=record.rule if record and memory is not None else host.rule,
            program=self._workspace.source.name if self.program else "", edited=self._script.edited,
            record=record, runs=host.runs_expected,
        )  # fmt: skip

    # ------------------------------------------------------------------ the program

    def accept(self, source: Source) -> tuple[Diagnostic, ...]:
        """Make `source` the active program (the OK button). Returns its problems; none of them is raised.

        A script that stopped at STOP cannot go on afterwards (error 43), unless the text is the same.
        """
        before = self._workspace.source.text
        program = self._workspace.accept(source, is_checked=self._listener.wants_check)
        if self._script.stopped is not None and source.text != before:
            self._script.edited = True
        self._notebook.program(source)
        if self._listener.wants_check:
            problems = self.check(source, quick=True, seconds=CHECK_SECONDS)  # the run compares the JACOBIAN
        else:
            problems = tuple(p.within(source) for p in program.problems)
        self._listener.program_accepted(program, problems)
        return problems

    def check(
        self, source: Source, *, quick: bool = False, seconds: float | None = None
    ) -> tuple[Diagnostic, ...]:
        """Return all problems of a text without touching the session, in the order of their places.

        Parser, structure, static check; for a text without errors also JACOBIAN segments that disagree with
        the model (warnings 462). `quick` leaves those out, which may take some 20 ms. After so many `seconds`
        of processor time it stops; warning 476 then says how far it came.
        """
        return self._checker.check(source, quick=quick, seconds=seconds)

    def override(self, settings: Mapping[str, float]) -> None:
        """Give quantities values that the script does not change, from the next `accept` on.

        Names are those of scalars, `a`, or of elements, `a[2]`, `A[1,3]`; ValueError for others. Segments and
        commands change them as ever.
        """
        if settings:
            from desire_tui.engine.session.overrides import name_and_subscripts

            for name in settings:
                name_and_subscripts(name)
        self._workspace.overrides = dict(settings)

    def keep(self, expressions: KeptExpressions | None) -> None:
        """Let every run from now on compute and sample some expressions besides its program's own."""
        self._workspace.segments.keep(expressions)

    def remember_segments(self) -> None:
        """Keep compiled segments while the same program is run anew again and again, as in a study.

        What a model has to say before its first run is then said once.
        """
        self._workspace.segments.remember()

    def set_breakpoints(self, lines: Iterable[int]) -> None:
        """Stop the script before these lines (from 1) of the active program, as at a STOP.

        Takes effect at once, also in a script that runs or is stopped, and from any thread.
        """
        self._script.set_breakpoints(frozenset(lines))

    @staticmethod
    def script_lines(source: Source) -> frozenset[int]:
        """Return the lines (from 1) of a text that hold a statement of the script or go on with one."""
        from desire_tui.engine.syntax.parse import parse

        row_of = source.position
        return frozenset(
            row
            for placed in parse(source).script
            for row in range(row_of(placed.at).row, row_of(placed.at + placed.node.end - 1).row + 1)
        )

    def new(self) -> None:
        """Forget the program and all quantities; scale 1, irule 1 (`NEW`)."""
        self._workspace.forget()
        self._script.forget()
        self._host.rule = DEFAULT_RULE

    # ------------------------------------------------------------------ running

    def erun(self, source: Source | None = None) -> None:
        """Accept `source` (default: the editor in front, else the active program), clear all names, run."""
        source = source or self._listener.front_source() or (self.program.source if self.program else None)
        if source is None:
            raise DesireError(Diagnostic("no-program"))
        command = "" if self._workspace.overrides else "zz"
        with self._notebook.task(command, lambda: self.graph), self._script.working(source):
            self.accept(source)
            self._host.rule = DEFAULT_RULE
            self._script.run(scale=1.0)

    def run(self) -> None:
        """Run the active program's script again from the top, keeping irule and scale.

        It runs as its text says: settings that held for the last run only (`override`) are over.
        """
        self._workspace.run_as_written()
        with self._notebook.task("run", lambda: self.graph):
            self._script.run(scale=self.values.cells[SCALE])

    def repeated(self, assignments: Sequence[Placed]) -> Callable[[], None]:
        """Return what makes some of the script's assignments once more, as it stands now."""
        return self._script.repeated(assignments)

    def prepare(self, source: Source, segment: str | None = None) -> PreparedRun:
        """Run a program's script as far as its first `drun` (of that labelled segment) and return that run.

        A script without one runs to its end; then it is the run that could follow. A STOP stops nothing.
        DesireError: as `erun`, and what is wrong with the segment.
        """
        from desire_tui.engine.session.prepared_run import PreparedRun, RunReached

        self._host.prepares = (segment,)
        reached = RunReached(segment, None)
        try:
            self.erun(source)
            while self.stopped_at is not None:
                self.go()
        except RunReached as first:
            reached = first
        finally:
            self._host.prepares = None
        return PreparedRun(self._workspace, self._runs, self._control, reached, self._host.rule)

    def go(self) -> None:
        """Continue after STOP; error 43 if there is nothing to continue or the program was edited."""
        with self._notebook.task("go", lambda: self.graph):
            self._script.go()

    def execute(self, text: str) -> None:
        """Carry out one command line; an empty line does nothing."""
        from desire_tui.engine.syntax.parse import parse_command

        source = Source(text, "<command>")
        statements, problems = parse_command(source)
        if problems:
            raise DesireError(*(p.within(source) for p in problems))
        if not statements:
            return
        with self._notebook.task(text, lambda: self.graph):
            self._commands.carry_out_line(statements, source, self._script.interpret)

    # ------------------------------------------------------------------ steering, from any thread

    def pause(self) -> None:
        """Hold the run or the script within 0.1 s; nothing happens when idle."""
        self._control.pause()

    def resume(self) -> None:
        """Go on after `pause`."""
        self._control.resume()

    def evaluate_while_running(self, text: str) -> str | None:
        """Return what a command line such as `write 2*x` writes at this moment, also while a run goes on.

        None: it does more than write to the console, or the model is too large for that. DesireError.
        """
        if self._workspace.program is None or self._workspace.structure is None:
            return None
        from desire_tui.engine.session.evaluate_while_running import evaluate_while_running

        return evaluate_while_running(text, self._workspace.program, self._workspace.structure, self.values)

    def end(self) -> None:
        """End the run and the script; the samples stay. The waiting call raises error 301."""
        self._control.end()

    # ------------------------------------------------------------------ results

    def snapshot(self, path: Path, graph: Graph | None = None, options: PictureOptions | None = None) -> Path:
        """Write a graph (default: the newest) as PNG, SVG or PDF by the path's ending; returns the path.

        DesireError 34: another ending, 106: cannot be written, 471: no graph yet.
        """
        graph = graph or self.graph
        if graph is None:
            raise DesireError(Diagnostic("no-graph"))
        from desire_tui.engine.outputs.picture_files import write_picture
        from desire_tui.engine.outputs.picture_options import FOR_PAPER

        write_picture(graph, path, options or FOR_PAPER)
        self._notebook.picture(path)
        return path

    def note_result(self, command: str, text: str, graph: Graph | None) -> None:
        """Put what was asked beside the program, and the answer, into the notebook. The session's thread."""
        with self._notebook.task(command, lambda: graph):
            self._notebook.output(text)

    def plot_quantities(self, names: str) -> tuple[PlotOutcome, str]:
        """Plot `x`, `A`, `A[2,3]` or several (`x, position`) on a page: arrays over the index, others over t.

        What the last run did not record is recorded by making it once more. Belongs to the session's thread.
        """
        from desire_tui.engine.session.quantity_plots import plot_quantities

        show = self._listener.graph_changed
        with self._activity.working(State.RUNNING):
            return plot_quantities(self._workspace, self._runs, self.graphs, names, show)

    def help(self, topic: str = "") -> str:
        """Return the help page (Markdown) of a statement, function, command or error number."""
        return self._commands.help_page(topic)


def _draw(graph: Graph, path: Path) -> None:
    from desire_tui.engine.outputs.picture_files import write_picture

    write_picture(graph, path)
