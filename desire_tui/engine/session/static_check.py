"""All problems of a text, found without running it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.cancellation import OutOfTime, time_limit
from desire_tui.engine.diagnostics import Diagnostic
from desire_tui.engine.source import Span

if TYPE_CHECKING:
    from desire_tui.engine.source import Source


class StaticChecker:
    """Checks texts, and keeps the last answer: the editor and `accept` ask about the same text.

    May be asked from any thread.
    """

    def __init__(self) -> None:
        # one reference, so that another thread never sees half of it
        self._last: tuple[Source | None, bool, tuple[Diagnostic, ...]] = (None, False, ())

    def check(self, source: Source, *, quick: bool, seconds: float | None) -> tuple[Diagnostic, ...]:
        """Return the problems in the order of their places; `quick`: without comparing JACOBIAN segments.

        After so many seconds of the processor's time it stops; a warning then says where.
        """
        known, whole, problems = self._last
        if known == source and (whole or quick):
            return problems
        finished = True
        with time_limit(seconds):
            try:
                problems = _problems(source, quick=quick)
            except OutOfTime as end:
                finished = False
                problems = (*end.found, _stopped(source, end))
        problems = tuple(d.within(source) for d in _in_order(problems))
        if finished or seconds is not None:
            self._last = (source, finished and not quick, problems)
        return problems


def _problems(source: Source, *, quick: bool) -> tuple[Diagnostic, ...]:
    from desire_tui.engine.check.checker import check
    from desire_tui.engine.session.dry_run import wrong_jacobians
    from desire_tui.engine.syntax.parse import parse

    program = parse(source)
    problems = check(program)
    if quick or any(d.severity == "error" for d in problems):
        return problems
    try:
        return (*problems, *wrong_jacobians(program))
    except OutOfTime:  # a closer look, no more
        return problems


def _stopped(source: Source, end: OutOfTime) -> Diagnostic:
    """Say how far a check has come."""
    start = end.reached or 0
    facts = {"line": source.position(start).row}
    return Diagnostic("check-incomplete", Span(start, start), facts, source, severity="warning")


def _in_order(problems: tuple[Diagnostic, ...]) -> list[Diagnostic]:
    return sorted(problems, key=lambda d: d.span or (0, 0))
