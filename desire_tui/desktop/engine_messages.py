"""What the engine's thread reports to the screen. Handlers own all state; the thread touches no widget."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.message import Message

if TYPE_CHECKING:
    import threading
    from collections.abc import Sequence

    from desire_tui.engine.diagnostics import Diagnostic
    from desire_tui.engine.runtime.run_record import RunRecord
    from desire_tui.engine.session.listener import StoppedAt
    from desire_tui.engine.session.permissions import PermissionRequest


class EngineMessage(Message):
    """Anything from the engine's thread."""

    bubble = False


class EngineReady(EngineMessage):
    """The engine is imported; the session is there."""


class EngineMissing(EngineMessage):
    """The engine cannot be imported."""

    def __init__(self, error: Exception) -> None:
        super().__init__()
        self.error = error


class ConsoleText(EngineMessage):
    """There is new console output; it waits in the listener, so that a flood of lines is one message."""

    def can_replace(self, message: Message) -> bool:
        """Only the newest matters: the text itself is not in the message."""
        return isinstance(message, ConsoleText)


class InputRequested(EngineMessage):
    """The script asks for a line; the engine waits for `listener.answer(…)`."""

    def __init__(self, prompt: str) -> None:
        super().__init__()
        self.prompt = prompt


class PermissionRequested(EngineMessage):
    """The program wants to do something it must ask for."""

    def __init__(self, request: PermissionRequest, answer: PermissionAnswer) -> None:
        super().__init__()
        self.request = request
        self.answer = answer


class ProgramAccepted(EngineMessage):
    """A text became the active program."""

    def __init__(self, problems: Sequence[Diagnostic]) -> None:
        super().__init__()
        self.problems = problems


class RunStarted(EngineMessage):
    """A run begins; its record grows from now on."""

    def __init__(self, record: RunRecord) -> None:
        super().__init__()
        self.record = record


class RunEnded(EngineMessage):
    """A run ended."""

    def __init__(self, record: RunRecord) -> None:
        super().__init__()
        self.record = record


class ProblemsFound(EngineMessage):
    """Problems of a program or a command. `stops`: they ended the script."""

    def __init__(self, diagnostics: Sequence[Diagnostic], *, stops: bool) -> None:
        super().__init__()
        self.diagnostics = tuple(diagnostics)
        self.stops = stops


class CheckFinished(EngineMessage):
    """The problems of a tab's text, found while typing."""

    def __init__(self, number: int, version: int, diagnostics: Sequence[Diagnostic]) -> None:
        super().__init__()
        self.number = number
        self.version = version
        self.diagnostics = tuple(diagnostics)


class Stopped(EngineMessage):
    """The script stands at a STOP, a breakpoint or, tracing, before the next statement."""

    def __init__(self, place: StoppedAt) -> None:
        super().__init__()
        self.place = place


class LineWanted(EngineMessage):
    """A row of the active program is to be seen: counted from 1."""

    def __init__(self, row: int) -> None:
        super().__init__()
        self.row = row


class GraphChanged(EngineMessage):
    """Another graph, or something on it that is not a run's sample."""

    def can_replace(self, message: Message) -> bool:
        """Only the newest matters."""
        return isinstance(message, GraphChanged)


class QuantitiesCleared(EngineMessage):
    """All names were cleared."""


class NoteWritten(EngineMessage):
    """A `note` of the program."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.text = text


class AppCommand(EngineMessage):
    """A program or command line gave a command about editors and files."""

    def __init__(self, word: str, argument: str) -> None:
        super().__init__()
        self.word = word
        self.argument = argument


class EngineIdle(EngineMessage):
    """A job of the engine's thread is done; nothing waits."""

    def __init__(self, *, failed: bool) -> None:
        super().__init__()
        self.failed = failed


class EngineFault(EngineMessage):
    """A fault of this program, not of the user: where it is written up."""

    def __init__(self, summary: str, details: str) -> None:
        super().__init__()
        self.summary = summary
        self.details = details


class PermissionAnswer:
    """A yes or no that another thread waits for."""

    def __init__(self, done: threading.Event) -> None:
        self.done = done
        self.yes = False

    def give(self, yes: bool) -> None:
        """Answer."""
        self.yes = yes
        self.done.set()
