"""All problems of a text, found without running it."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from desire_tui.engine.diagnostics import Diagnostic
    from desire_tui.engine.source import Source


class StaticChecker:
    """Checks texts, and keeps the last answer: the editor and `accept` ask about the same text.

    May be asked from any thread.
    """

    def __init__(self) -> None:
        # one reference, so that another thread never sees half of it
        self._last: tuple[Source | None, bool, tuple[Diagnostic, ...]] = (None, False, ())

    def check(self, source: Source, *, quick: bool) -> tuple[Diagnostic, ...]:
        """Return the problems in the order of their places; `quick`: without comparing JACOBIAN segments."""
        from desire_tui.engine.check.checker import check
        from desire_tui.engine.session.dry_run import wrong_jacobians
        from desire_tui.engine.syntax.parse import parse

        known, whole, problems = self._last
        if known == source and (whole or quick):
            return problems
        program = parse(source)
        problems = check(program)
        if not quick and not any(d.severity == "error" for d in problems):
            problems = tuple(sorted((*problems, *wrong_jacobians(program)), key=lambda d: d.span or (0, 0)))
        problems = tuple(d.within(source) for d in problems)
        self._last = (source, not quick, problems)
        return problems
