"""The front end of a headless run: it passes on console text, and answers questions from a file or pipe."""

from __future__ import annotations

import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING

from desire_tui.engine.interpreter.host import Interrupted
from desire_tui.engine.session.listener import Listener

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from desire_tui.engine.diagnostics import Diagnostic

CONSOLE_CHARACTERS_MAX = 100_000_000
"""Console text kept for the JSON; what a runaway program writes beyond that is only passed on."""


class HeadlessListener(Listener):
    """Passes console text to `show` as it comes and keeps it; reads answers line by line.

    `echo` writes each answer behind its question, as a terminal does.
    """

    def __init__(
        self,
        show: Callable[[str], object],
        answers: Iterator[str],
        show_problems: Callable[[Sequence[Diagnostic]], object],
        *,
        echo: bool = True,
    ) -> None:
        self._show = show
        self._answers = answers
        self._show_problems = show_problems
        self._echo = echo
        self._parts: list[str] = []
        self._size = 0
        self.warnings: list[Diagnostic] = []
        self.reading = threading.Event()
        """Set while standard input is being read: nothing can interrupt the thread there."""
        self.lost: OSError | None = None
        """Why nobody can be told anything any more, such as a closed pipe."""

    @property
    def console(self) -> str:
        """All console text so far."""
        return "".join(self._parts)

    def mark(self) -> tuple[int, int]:
        """Return how much has been heard so far, for `rewind`."""
        return len(self._parts), len(self.warnings)

    def rewind(self, mark: tuple[int, int]) -> None:
        """Forget what was heard since."""
        del self._parts[mark[0] :], self.warnings[mark[1] :]
        self._size = sum(map(len, self._parts))

    def console_text(self, text: str) -> None:
        """Pass on and keep."""
        if self._size < CONSOLE_CHARACTERS_MAX:
            self._parts.append(text)
            self._size += len(text)
        with self._noticing_loss():
            self._show(text)

    def ask(self, prompt: str) -> str:
        """Show the prompt, take the next line."""
        self.console_text(prompt)
        self.reading.set()
        try:
            line = next(self._answers)
        except StopIteration:
            raise EOFError from None
        except KeyboardInterrupt:
            raise Interrupted from None
        finally:
            self.reading.clear()
        line = line.rstrip("\r\n")
        if self._echo:
            self.console_text(line + "\n")
        return line

    wants_check = False  # a problem is reported when the program reaches it

    def problems(self, diagnostics: Sequence[Diagnostic]) -> None:
        """Show warnings as they come."""
        self.warnings.extend(diagnostics)
        with self._noticing_loss():
            self._show_problems(diagnostics)

    @contextmanager
    def _noticing_loss(self) -> Iterator[None]:
        try:
            yield
        except OSError as error:
            self.lost = error
            raise
