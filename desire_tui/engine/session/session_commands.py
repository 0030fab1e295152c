"""Commands about the session (language.md 6): erun, run, go, list, snapshot, notebook, compare, help."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.interpreter.host import Interrupted
from desire_tui.engine.nodes.commands import FileCommand, Simple
from desire_tui.engine.nodes.control import For, If, While
from desire_tui.engine.nodes.files import Dump
from desire_tui.engine.session.report import run_report
from desire_tui.engine.session.status import State

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from desire_tui.engine.graph.pages import GraphPages
    from desire_tui.engine.nodes.program import Placed
    from desire_tui.engine.nodes.statements import Statement
    from desire_tui.engine.session.activity import Activity
    from desire_tui.engine.session.console import Console
    from desire_tui.engine.session.listener import Listener
    from desire_tui.engine.session.runs import Runs
    from desire_tui.engine.session.workspace import Workspace
    from desire_tui.engine.source import Source

_OWN_WORDS = frozenset(
    {"erun", "run", "go", "list", "list+", "bye", "new", "NEW", "ed", "edit", "auto", "reload", "keep+"}
)

_REPLACES_THE_PROGRAM = frozenset({"erun", "run", "go", "new", "NEW", "reload", "bye"})


class ProgramControl(Protocol):
    """What commands ask of the session as a whole."""

    def erun(self) -> None:
        """Accept the text in front and run it."""

    def run(self) -> None:
        """Run the active program's script again from the top."""

    def go(self) -> None:
        """Continue after STOP."""

    def new(self) -> None:
        """Forget the program and all quantities."""

    def snapshot(self, path: Path) -> Path:
        """Write the newest graph to a file."""
        ...


class SessionCommands:
    """Carries out what is no statement of a script."""

    def __init__(
        self,
        programs: ProgramControl,
        workspace: Workspace,
        listener: Listener,
        console: Console,
        activity: Activity,
        runs: Runs,
        graphs: GraphPages,
    ) -> None:
        self._programs = programs
        self._workspace = workspace
        self._listener = listener
        self._console = console
        self._activity = activity
        self._runs = runs
        self._graphs = graphs

    def _is_own(self, node: Statement) -> bool:
        """Whether a statement of a command line is carried out here rather than by the interpreter."""
        match node:
            case Simple(word=word):
                return word in _OWN_WORDS
            case FileCommand(word="sh"):
                return False
            case FileCommand():
                return True
            case Dump(what="run"):
                return True
        return False

    def carry_out_line(
        self,
        statements: Sequence[Placed],
        source: Source,
        interpret: Callable[[list[Placed], Source], object],
    ) -> None:
        """Carry out a command line; what is no command goes to `interpret`, together as it stands."""
        waiting: list[Placed] = []
        divides = self._divides(statements)
        for placed in statements:
            if divides and self._is_own(placed.node):
                interpret(waiting, source)
                waiting = []
                self._carry_out_statement(placed, source)
            else:
                waiting.append(placed)
        interpret(waiting, source)

    def _divides(self, statements: Sequence[Placed]) -> bool:
        """Whether own commands part a line: not those in blocks, which the interpreter hands back in turn."""
        nodes = [placed.node for placed in statements]
        if any(isinstance(node, Simple) and node.word in _REPLACES_THE_PROGRAM for node in nodes):
            return True
        return not any(
            isinstance(node, If | For | While) or (isinstance(node, Simple) and node.word == "repeat")
            for node in nodes
        )

    def _carry_out_statement(self, placed: Placed, source: Source) -> None:
        """Carry out a command; its problems get its place."""
        node = placed.node
        try:
            match node:
                case Simple():
                    self.carry_out(node.word, None)
                case FileCommand():
                    self.carry_out(node.word, node.argument)
                case _:
                    self.carry_out("dump", "run")
        except DesireError as error:
            raise DesireError(
                *(
                    d if d.source or d.span else Diagnostic(d.key, placed.span(), d.facts, source)
                    for d in error.diagnostics
                )
            ) from None

    def carry_out(self, word: str, argument: str | None) -> None:
        """Carry out a command by its word. DesireError 402: the front end has no such thing."""
        programs, write = self._programs, self._listener.console_text
        match word:
            case "erun":
                programs.erun()
            case "run":
                programs.run()
            case "go":
                programs.go()
            case "list" | "list+":
                write(self._listing(argument, numbered=word == "list+"))
            case "note":
                self._workspace.notebook.note(self._listing(argument, numbered=True))
            case "ed" | "edit" | "auto" if argument is not None or word == "auto":
                self._bring_into_view(argument or "")
            case "dump":
                if not self._runs.kept:
                    raise DesireError(Diagnostic("no-run"))
                self._console.write(run_report(self._runs.kept[-1]))
            case "compare":
                self._compare(argument)
            case "snapshot":
                self._snapshot(argument or "graph.png")
            case "notebook":
                self._notebook(argument)
            case "help" if not self._listener.command(word, argument):
                write(self._help(argument or "") + "\n")
            case "new" | "NEW":
                if not self._listener.command(word, argument):
                    programs.new()
            case "bye":
                self._listener.command(word, argument)  # without a desktop there is nothing to leave
            case "help":
                pass
            case _ if not self._listener.command(word, argument):
                raise DesireError(Diagnostic("command-elsewhere", facts={"word": word}))

    def help_page(self, topic: str) -> str:
        """Return a help page; DesireError 403 where there is none."""
        from desire_tui.help.page_catalogue import find, topics

        if not topic.strip():
            return "Help about: " + ", ".join(
                sorted({t.name for t in topics().values() if t.kind != "error"})
            )
        found = find(topic.strip())
        if found is None:
            raise DesireError(Diagnostic("no-help", facts={"topic": topic}))
        return found.markdown

    def _help(self, topic: str) -> str:
        """Return a help page, or that there is none: a program goes on."""
        try:
            return self.help_page(topic)
        except DesireError as error:
            return f"{error.diagnostics[0].message}: {error.diagnostics[0].hint}"

    def _bring_into_view(self, lines: str) -> None:
        """Show lines of the program in a desktop's editor; without a screen, and without lines, nothing."""
        from desire_tui.engine.syntax.line_numbers import rows_named

        program = self._workspace.program
        found = rows_named(program.source.text, lines) if program is not None else []
        if found:
            self._listener.line_wanted(found[0].rows.start + 1)

    def _listing(self, lines: str | None, *, numbered: bool) -> str:
        program = self._workspace.program
        if program is None:
            raise DesireError(Diagnostic("no-program"))
        text = program.source.text.rstrip("\n") + "\n"
        from desire_tui.engine.syntax.line_numbers import listing, with_numbers

        if lines is not None:
            return listing(text, lines)
        return with_numbers(text) if numbered else text

    def _compare(self, argument: str | None) -> None:
        from desire_tui.engine.session.comparison import Variation, compare_runs

        change = Variation.parse(argument or "")
        try:
            with self._activity.working(State.RUNNING):
                table = compare_runs(
                    self._workspace, self._runs, self._graphs, change, self._listener.graph_changed
                )
        except Interrupted:
            if self._activity.state is State.IDLE:
                raise DesireError(Diagnostic("stopped-by-user")) from None
            raise  # the script that compares ends too
        self._console.write(table)

    def _notebook(self, argument: str | None) -> None:
        notebook = self._workspace.notebook
        if argument in ("on", "off"):
            if argument == "on" and notebook.path is None:
                notebook.open(self._file("notebook.md"))
            notebook.switch(on=argument == "on")
        else:
            notebook.open(self._file(argument or "notebook.md"))
            if self._workspace.program is not None:
                notebook.program(self._workspace.source)
        state = f"on: {notebook.path}" if notebook.is_on else "off"
        self._listener.console_text(f"notebook {state}\n")

    def _snapshot(self, name: str) -> None:
        from desire_tui.engine.outputs.picture_files import picture_format

        if self._graphs.current is None:
            raise DesireError(Diagnostic("no-graph"))
        picture_format(Path(name))  # before anybody is asked about the file
        path = self._programs.snapshot(self._file(name))
        self._listener.console_text(f"{path}\n")

    def _file(self, name: str) -> Path:
        return self._workspace.permit(Path(name), "write", self._listener.permit)
