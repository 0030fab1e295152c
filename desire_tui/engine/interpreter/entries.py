"""Entries typed at a prompt or read from a file: expressions separated by newlines, commas and tabs."""

from __future__ import annotations

import re
from collections import deque
from math import inf
from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.interpreter.exception_mapping import ScriptFault, explain
from desire_tui.engine.interpreter.host import Interrupted
from desire_tui.engine.nodes.assignments import Bare
from desire_tui.engine.source import Source, Span

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.interpreter.statement_context import StatementContext
    from desire_tui.engine.nodes.program import Placed

_SEPARATOR = re.compile(r"[,;\t]")
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")


class Entries:
    """Values in the order they come. From the console a bad entry is asked for again, and `!` breaks off."""

    def __init__(self, context: StatementContext, read_line: Callable[[], str], origin: str) -> None:
        self._context = context
        self._read_line = read_line
        self._origin = origin
        self._prompt: str | None = None
        self._fits: Callable[[complex], Diagnostic | None] = lambda _: None
        self._waiting: deque[str] = deque()

    def ask(self, name: str, fits: Callable[[complex], Diagnostic | None]) -> None:
        """Take values from the console from now on, prompting with a name.

        `fits` returns what is wrong with a value that the name cannot take.
        """
        self._prompt = f"{name} ? "
        self._fits = fits

    def next(self) -> complex:
        """Return the next value; errors 18 and 197."""
        while True:
            while not self._waiting:
                line = self._ask_line() if self._prompt is not None else self._read_line()
                self._waiting.extend(split_entries(line))
            text = self._waiting.popleft()
            if self._prompt is not None and text == "!":
                raise DesireError(Diagnostic("input-broken-off"))
            try:
                return self._value(text)
            except DesireError as problem:
                if self._prompt is None:
                    facts = {"entry": text, "origin": self._origin, "reason": problem.diagnostics[0].message}
                    raise DesireError(Diagnostic("bad-entry", facts=facts)) from problem
                self._context.host.warn(problem)
                self._waiting.clear()

    def _ask_line(self) -> str:
        assert self._prompt is not None
        try:
            return self._context.host.ask(self._prompt)
        except EOFError:
            raise DesireError(Diagnostic("input-ended")) from None

    def _value(self, text: str) -> complex:
        """Return the value of an entry; DesireError of one that is no value, or none that fits."""
        value: complex = float(text) if _NUMBER.fullmatch(text) else inf
        if abs(value) == inf:
            value = self._evaluate(text)
        wrong = self._fits(value)
        if wrong is not None:
            source = Source(text, f"<{self._origin}>")
            raise DesireError(Diagnostic(wrong.key, Span(0, len(text)), wrong.facts, source))
        return value

    def _evaluate(self, text: str) -> complex:
        from desire_tui.engine.syntax.parse import parse_command

        source = Source(text, f"<{self._origin}>")
        statements, problems = parse_command(source)
        if problems:
            raise DesireError(*(problem.within(source) for problem in problems))
        if len(statements) != 1 or not isinstance(statements[0].node, Bare):
            raise DesireError(Diagnostic("entry-not-a-value", Span(0, len(text)), {"entry": text}, source))
        placed: Placed = statements[0]
        assert isinstance(placed.node, Bare)
        machine = self._context.machine
        known = len(machine.origins)
        try:
            code, _ = self._context.translator.finite(placed.node.value)
            value: complex = machine.build.evaluate(code, placed, source)
        except Interrupted:
            raise
        except (ScriptFault, ArithmeticError, ValueError) as error:
            raise explain(error, placed, source, machine.origins) from error
        finally:
            machine.origins.forget_from(known)
        return value


def split_entries(line: str) -> list[str]:
    """Split a line at commas, semicolons and tabs outside brackets, and at blanks between numbers."""
    entries: list[str] = []
    depth, start = 0, 0
    for index, character in enumerate(line):
        if character in "([":
            depth += 1
        elif character in ")]":
            depth -= 1
        elif depth <= 0 and _SEPARATOR.match(character):
            entries.append(line[start:index])
            start = index + 1
    entries.append(line[start:])
    parts: list[str] = []
    for entry in entries:
        words = entry.split()
        if len(words) > 1 and all(map(_NUMBER.fullmatch, words)):
            parts.extend(words)
        elif words:
            parts.append(entry.strip())
    return parts
