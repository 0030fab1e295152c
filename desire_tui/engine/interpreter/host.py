"""What the interpreter asks of the world around it. The session implements it; tests use a small stand-in."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, Protocol

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from desire_tui.engine.diagnostics import DesireError
    from desire_tui.engine.nodes.program import Placed
    from desire_tui.engine.values import Quantity


class Host(Protocol):
    """Calls out of the script. Everything here may raise DesireError; the interpreter adds the place."""

    rule: int
    """`irule`, 1 if never set."""

    def write(self, text: str) -> None:
        """Console output, exactly this text."""

    def ask(self, prompt: str) -> str:
        """Console input: one line without its end. EOFError: no more; Interrupted stops the script."""
        ...

    def drun(self, label: str | None, placed: Placed, *, star: bool) -> None:
        """Make one simulation run of a segment, to its end. `Interrupted` if the user ended it."""

    def reset(self) -> None:
        """Restore t, DT and states to the start of the last run."""

    def display(self, mode: str, args: Sequence[float]) -> None:
        """Carry out a `display` statement."""

    def name_graph(self, part: str, text: str) -> None:
        """Give graphs a `title`, `xlabel` or `ylabel`."""

    def plot(self, x: float, y: float, color: int | None) -> None:
        """Draw one point of an interpreter plot."""

    def show(self, quantity: Quantity, columns: int) -> None:
        """Show an array as a picture."""

    def show_area(self, *, by_size: bool) -> None:
        """Let the pictures to come show size (`SHOW *`) or colour (`SHOW`)."""

    def note(self, text: str) -> None:
        """Append to the notebook."""

    def shell(self, command: str) -> None:
        """Run a shell command if that is allowed (error 450 otherwise)."""

    def permit(self, path: Path, mode: Literal["read", "write"]) -> Path:
        """Return the resolved path (relative to the program's folder) if it may be opened; else error 451."""
        ...

    def command(self, word: str, argument: str | None) -> None:
        """Carry out a command about editors, files and graphs: ed, keep, load, snapshot, help, …."""

    def before(self, placed: Placed) -> None:
        """Hear of the next statement while `Interpreter.stepping` is on; may wait, or `stop_here()`."""

    def interrupted(self) -> bool:
        """Whether the user wants the script to end; asked at every jump back and every 1000 statements."""
        ...

    def warn(self, problem: DesireError) -> None:
        """Show a problem without stopping."""


class Interrupted(Exception):  # noqa: N818 - a user's wish, not an error
    """The user ended the script (errors 301, 302)."""
