"""Command lines: what the desktop does itself, what goes to the engine, and what is possible during a run."""

from __future__ import annotations

import re
from collections import deque
from functools import partial

from desire_tui.actions import Controller
from desire_tui.commands import REFERENCE_WORDS, Command, parse_line
from desire_tui.engine.session import State
from desire_tui.panes.quantities import value_text

_NAMES = re.compile(r"(?:write\s+)?[A-Za-z][\w$]*(?:\s*[,;]\s*[A-Za-z][\w$]*)*\s*$")
DURING_A_RUN = "During a run names alone show their values. Ctrl+C pauses, Space Enter ends it."


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
        if state in (State.RUNNING, State.PAUSED) and len(lines) == 1 and parse_line(lines[0]) is None:
            self._during_a_run(lines[0])
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
            own = self._own(self._queue[0])
            if own is None and self.app.engine.is_busy:
                return
            line = self._queue.popleft()
            self._echo(line)
            if own is not None:
                command, argument = own
                self.app.do(command.id, argument)
            else:
                self.app.engine.submit(partial(self.app.session.execute, line))

    def _own(self, line: str) -> tuple[Command, str] | None:
        """Return the desktop's action a line means; a quantity of that name is shown instead."""
        word = line.strip()
        if word not in REFERENCE_WORDS and self.app.engine.is_up:
            quantity = self.app.session.values.find(word)
            if quantity is not None and self.app.session.values.is_defined(quantity):
                return None
        return parse_line(line)

    def forget(self) -> None:
        """Drop the lines that wait."""
        self._queue.clear()

    def _during_a_run(self, line: str) -> None:
        """Show the values of names; anything else has to wait for the end of the run."""
        self._echo(line)
        words = re.findall(r"[A-Za-z][\w$]*", line) if _NAMES.match(line.strip()) else []
        names = words[1:] if words[:1] == ["write"] and len(words) > 1 else words
        values = self.app.session.values
        found = [quantity for name in names if (quantity := values.find(name)) is not None]
        if found and len(found) == len(names):
            text = "\t".join(value_text(values, quantity) for quantity in found)
            self.app.command.console.add(text, "output")
        else:
            self.app.command.console.add(DURING_A_RUN, "notice")

    def _echo(self, line: str) -> None:
        self.app.news.flush()
        self.app.command.console.add(f"> {line}", "command")
