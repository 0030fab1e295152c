"""A host for scripts that keeps what they write, ask and do in lists."""

from __future__ import annotations

from pathlib import Path

from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.interpreter.host import Interrupted
from desire_tui.engine.interpreter.interpreter import Interpreter
from desire_tui.engine.source import Source
from desire_tui.engine.structure.structure import structure
from desire_tui.engine.syntax.parse import parse, parse_command
from desire_tui.engine.values import Kind, Values


class RecordingHost:
    """Implements `interpreter.Host`."""

    def __init__(self, folder: Path | None = None) -> None:
        self.rule = 1
        self.folder = folder
        self.values = Values()
        self.written: list[str] = []
        self.calls: list[tuple] = []
        self.answers: list[str] = []
        self.warnings: list[DesireError] = []
        self.looks = 0
        self.looks_allowed: int | None = None
        self.on_drun = None
        self.interpreter: Interpreter | None = None

    @property
    def text(self) -> str:
        return "".join(self.written)

    def write(self, text: str) -> None:
        self.written.append(text)

    def ask(self, prompt: str) -> str:
        self.written.append(prompt)
        if not self.answers:
            raise EOFError
        return self.answers.pop(0)

    def drun(self, label, placed, *, star) -> None:
        self.calls.append(("drun", label, star))
        if self.on_drun:
            self.on_drun(self, label)

    def reset(self) -> None:
        self.calls.append(("reset",))

    def display(self, mode, args) -> None:
        self.calls.append(("display", mode, *args))

    def name_graph(self, part, text) -> None:
        self.calls.append(("name_graph", part, text))

    def plot(self, x, y, color) -> None:
        self.calls.append(("plot", x, y, color))

    def show(self, quantity, columns) -> None:
        self.calls.append(("show", quantity.name, columns))

    def show_area(self, *, by_size) -> None:
        self.calls.append(("show area", by_size))

    def note(self, text) -> None:
        self.calls.append(("note", text))

    def shell(self, command) -> None:
        self.calls.append(("shell", command))

    def permit(self, path, mode):
        return (self.folder or Path.cwd()) / path

    def command(self, word, argument) -> None:
        self.calls.append(("command", word, argument))

    def before(self, placed) -> None:
        self.calls.append(("before", type(placed.node).__name__))

    def interrupted(self) -> bool:
        self.looks += 1
        return self.looks_allowed is not None and self.looks > self.looks_allowed

    def warn(self, problem) -> None:
        self.warnings.append(problem)

    # ------------------------------------------------------------------------------- for tests

    def load(self, text: str) -> Interpreter:
        program = parse(Source(text, "test.src"))
        if program.problems:
            raise DesireError(*program.problems)
        self.interpreter = Interpreter(program, structure(program), self.values, self)
        return self.interpreter

    def run(self, text: str) -> RecordingHost:
        self.load(text).run()
        return self

    def execute(self, line: str) -> RecordingHost:
        source = Source(line, "<command>")
        statements, problems = parse_command(source)
        if problems:
            raise DesireError(*problems)
        if self.interpreter is None:
            self.load("")
        self.interpreter.execute(statements, source)
        return self

    def __getitem__(self, name: str):
        quantity = self.values.names[name]
        if quantity.shape:
            return self.values.view(quantity)
        assert self.values.is_defined(quantity), f"{name} is undefined"
        cells = self.values.cells
        if quantity.kind is Kind.COMPLEX:
            return complex(cells[quantity.slot], cells[quantity.slot + 1])
        return cells[quantity.slot]


def run(text: str, *answers: str, folder: Path | None = None) -> RecordingHost:
    host = RecordingHost(folder)
    host.answers = list(answers)
    return host.run(text)


def error_of(text: str, *answers: str, folder: Path | None = None) -> tuple[int, str]:
    """The error number of a program, and the piece of text it points at."""
    try:
        run(text, *answers, folder=folder)
    except DesireError as error:
        problem = error.diagnostics[0]
        assert problem.message
        assert "…" not in problem.message  # a missing fact shows as …
        piece = text[problem.span.start : problem.span.end] if problem.span else ""
        return problem.code, piece
    raise AssertionError("no error")


__all__ = ["Interrupted", "RecordingHost", "error_of", "run"]
