"""Command lines: what the desktop does itself, what goes to the engine, and what is possible during a run."""

from __future__ import annotations

import inspect
from collections import deque
from functools import partial
from typing import TYPE_CHECKING, Any

from desire_tui.actions import Controller
from desire_tui.commands import REFERENCE_WORDS, Command, parse_line
from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.session.status import State
from desire_tui.language.line_tokens import listed_names
from desire_tui.panes.value_summary import value_text

if TYPE_CHECKING:
    from collections.abc import Coroutine

    from desire_tui.app import DesireApp

DURING_A_RUN = "During a run names and write show values. Ctrl+C pauses, Space Enter ends it."


class CommandLine(Controller):
    """Takes lines from the command pane; pasted ones wait for each other, and stop where one fails."""

    def __init__(self, app: DesireApp) -> None:
        super().__init__(app)
        self._queue: deque[str] = deque()
        self._current = ""
        self._own_goes_on = False

    def enter(self, lines: list[str]) -> None:
        """Carry out lines, one after the other; a block that is pasted is carried out as a whole."""
        app = self.app
        if not app.engine.is_ready:  # typed while the desktop still opens: `next` comes with the engine
            self._queue.extend(blocks(lines))
            return
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
        self._queue.extend(blocks(lines))
        self.next()

    def next(self) -> None:
        """Carry out lines that wait, as far as the engine and the desktop are free for them."""
        while self._queue and not self._own_goes_on:
            own = self._own(self._queue[0])
            if own is None and self.app.engine.is_busy:
                return
            self._current = self._queue.popleft()
            self._echo(self._current)
            if own is None:
                self.app.engine.submit(partial(self.app.session.execute, self._current))
            else:
                self._do(*own)

    def _do(self, command: Command, argument: str) -> None:
        """Carry out an action of the desktop; what it asks the user is answered before the next line."""
        before = self.app.errors_reported
        self.app.keeps_answers = True
        try:
            result = self.app.call(command.id, argument)
        finally:
            self.app.keeps_answers = False

        async def finish(work: Coroutine[Any, Any, object]) -> None:
            try:
                self.app.keeps_answers = True
                await work
            finally:
                self.app.keeps_answers = False
                self._own_goes_on = False
            self._own_done(before)
            self.next()

        if inspect.iscoroutine(result):
            self._own_goes_on = True
            self.app.run_worker(finish(result), name=command.id, exit_on_error=True)
        else:
            self._own_done(before)

    def _own_done(self, errors_before: int) -> None:
        if self.app.errors_reported > errors_before:
            self.failed()

    def failed(self) -> None:
        """Stop: if lines wait behind the one that failed, all of them go back to the prompt."""
        if self._queue:
            held = [self._current, *self._queue]
            self.app.command.keep_pending([line for block in held for line in block.split("\n")])
            self._queue.clear()

    def answer(self) -> str | None:
        """Return the next line that waits as the answer to an `input`, None if there is none."""
        if not self._queue:
            return None
        line, _, others = self._queue.popleft().partition("\n")
        if others:
            self._queue.appendleft(others)
        return line

    def _own(self, line: str) -> tuple[Command, str] | None:
        """Return the desktop's action a line means; a quantity of that name is shown instead."""
        word = line.strip()
        if word not in REFERENCE_WORDS and self.app.engine.is_ready:
            quantity = self.app.session.values.find(word)
            if quantity is not None and self.app.session.values.is_defined(quantity):
                return None
        return parse_line(line)

    def forget(self) -> None:
        """Drop the lines that wait."""
        self._queue.clear()

    def _during_a_run(self, line: str) -> None:
        """Show values of names, and what only writes; anything else has to wait for the end of the run."""
        self._echo(line)
        names = listed_names(line)
        session, console = self.app.session, self.app.command.console
        values = session.values
        found = [quantity for name in names if (quantity := values.find(name)) is not None]
        if found and len(found) == len(names):
            text = "\t".join(value_text(values, quantity) for quantity in found)
            console.add(text, "output")
            return
        try:
            written = session.evaluate_while_running(line)
        except DesireError as error:
            self.app.command.problems(error.diagnostics)
            return
        if written is None:
            console.add(DURING_A_RUN, "notice")
        else:
            console.add(written.rstrip("\n"), "output")

    def _echo(self, line: str) -> None:
        self.app.message_handlers.flush()
        self.app.command.console.add("> " + line.replace("\n", "\n> "), "command")


def blocks(lines: list[str]) -> list[str]:
    """Return lines as they are carried out: one by one, those of a block or of a statement as one text.

    Lines that open a block which nothing closes stay single: each is reported as if it were typed.
    """
    if len(lines) < 2:
        return [line for line in lines if line.strip()]
    from desire_tui.editor.indent import closes, opens

    found: list[str] = []
    held: list[str] = []
    depth = 0
    for line in lines:
        if not line.strip():
            continue
        depth += opens(line) - (closes(line) and depth > 0)
        held.append(line)
        if depth == 0 and not line.rstrip().endswith("_"):
            found.append("\n".join(held))
            held = []
    return found + held
