"""Command lines: what the desktop does itself, what goes to the engine, and what is possible during a run."""

from __future__ import annotations

import re
from collections import deque
from functools import partial

from desire_tui.actions import Controller
from desire_tui.commands import parse_line
from desire_tui.engine.session import State
from desire_tui.panes.quantities import value_text

_NAMES = re.compile(r"(?:write\s+)?[A-Za-z][\w$]*(?:\s*[,;]\s*[A-Za-z][\w$]*)*\s*$")
ALWAYS = {"run.start", "run.again", "run.proceed", "run.live", "file.quit"}
"""Actions that a waiting list of lines does not hold up."""


class CommandLine(Controller):
    """Takes lines from the command pane; several pasted ones wait for each other."""

    _waiting: deque[str]

    def enter(self, lines: list[str]) -> None:
        """Carry out lines, one after the other."""
        app = self.app
        state = app.session.status.state
        if state is State.PAUSED and len(lines) == 1 and not lines[0].strip():
            if lines[0]:
                app.run_actions.end()
            else:
                app.run_actions.resume()
            return
        self._queue.extend(line for line in lines if line.strip())
        self.next()

    @property
    def _queue(self) -> deque[str]:
        if not hasattr(self, "_waiting"):
            self._waiting = deque()
        return self._waiting

    def next(self) -> None:
        """Carry out lines that wait, as far as the engine is free for them."""
        while self._queue:
            line = self._queue[0]
            own = parse_line(line)
            if self.app.engine.is_busy and own is None and not self._answer(line):
                if len(self._queue) == 1:
                    self._queue.clear()
                    self._echo(line)
                    self.app.command.console.add(
                        "A program is running: Ctrl+C pauses it, then Space Enter ends it. Names alone show values.",
                        "notice",
                    )
                return
            self._queue.popleft()
            self._echo(line)
            if own is not None:
                command, argument = own
                self.app.do(command.id, argument)
            elif self.app.engine.is_busy:
                self._show_values(line)
            else:
                self.app.engine.submit(partial(self.app.session.execute, line))

    def _echo(self, line: str) -> None:
        self.app.news.flush()
        self.app.command.console.add(f"> {line}", "command")

    def _answer(self, line: str) -> bool:
        """Whether a line can be answered during a run: names whose values are wanted."""
        if _NAMES.match(line.strip()) is None:
            return False
        words = re.findall(r"[A-Za-z][\w$]*", line)
        names = words[1:] if words[0] == "write" and len(words) > 1 else words
        return all(self.app.session.values.find(name) is not None for name in names)

    def _show_values(self, line: str) -> None:
        words = re.findall(r"[A-Za-z][\w$]*", line)
        names = words[1:] if words[0] == "write" and len(words) > 1 else words
        values = self.app.session.values
        found = [quantity for name in names if (quantity := values.find(name)) is not None]
        self.app.command.console.add("\t".join(value_text(values, quantity) for quantity in found), "output")
