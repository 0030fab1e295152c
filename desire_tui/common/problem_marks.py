"""Where a problem stands in a program's text. Rows and columns count from 0."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
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
