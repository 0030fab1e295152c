"""What stands beside the text: problems, breakpoints, the line being traced. Rows count from 0."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

    from desire_tui.engine.diagnostics import Diagnostic


@dataclass(frozen=True, slots=True)
class Mark:
    """A problem on one row, columns `start` … `end - 1`."""

    row: int
    start: int
    end: int
    style: str
    code: int
    message: str
    hint: str | None

    @property
    def text(self) -> str:
        """One line for people."""
        hint = f" — {self.hint}" if self.hint else ""
        return f"{self.style} {self.code}: {self.message}{hint}"


@dataclass
class Marks:
    """All marks of one editor."""

    problems: dict[int, list[Mark]] = field(default_factory=dict)
    breakpoints: set[int] = field(default_factory=set)
    traced: int | None = None

    def set_problems(self, diagnostics: Iterable[Diagnostic]) -> None:
        """Replace the problems."""
        self.problems = {}
        for diagnostic in diagnostics:
            mark = mark_of(diagnostic)
            if mark is not None:
                self.problems.setdefault(mark.row, []).append(mark)

    def shift(self, row: int, lines: int) -> None:
        """Lines were inserted (or, `lines` < 0, deleted) after `row`: move what stands below."""
        if not lines:
            return

        def moved(at: int) -> int:
            return at if at <= row else max(row, at + lines)

        self.breakpoints = {moved(at) for at in self.breakpoints}
        self.problems = {moved(at): marks for at, marks in self.problems.items()}
        if self.traced is not None:
            self.traced = moved(self.traced)

    def next_problem(self, row: int, step: int) -> Mark | None:
        """Return the first problem below `row` (step 1) or above it (step -1), going round at the end."""
        rows = sorted(self.problems)
        if not rows:
            return None
        beyond = [at for at in rows if (at - row) * step > 0]
        if step > 0:
            return self.problems[beyond[0] if beyond else rows[0]][0]
        return self.problems[beyond[-1] if beyond else rows[-1]][0]


def mark_of(diagnostic: Diagnostic) -> Mark | None:
    """Return where an editor shows a problem; None if it has no place in a text."""
    if diagnostic.span is None or diagnostic.source is None:
        return None
    start = diagnostic.source.position(diagnostic.span.start)
    end = diagnostic.source.position(diagnostic.span.end)
    last = end.column - 1 if end.row == start.row else len(diagnostic.source.line(start.row))
    return Mark(
        start.row - 1, start.column - 1, max(last, start.column), diagnostic.severity, diagnostic.code,
        diagnostic.message, diagnostic.hint,
    )  # fmt: skip
