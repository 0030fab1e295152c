"""Where a problem stands in a program's text. Rows and columns count from 0."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.data_classes import dataclass

if TYPE_CHECKING:
    from desire_tui.engine.diagnostics import Diagnostic
    from desire_tui.engine.source import Source, Span

_WORD = re.compile(r"[A-Za-z_$][\w$]*")


class Fix(NamedTuple):
    """What a problem's "did you mean" would change in its row: the word from column `start` on."""

    start: int
    old: str
    new: str

    @property
    def text(self) -> str:
        """The change, for people."""
        return f"{self.old} → {self.new}"


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
    fix: Fix | None = None

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
        diagnostic.message, diagnostic.hint, _fix(diagnostic, diagnostic.source, diagnostic.span),
    )  # fmt: skip


def _fix(diagnostic: Diagnostic, source: Source, span: Span) -> Fix | None:
    """Return the change that the hint proposes, if its word is found in the problem's first row."""
    new = diagnostic.facts.get("close")
    if not new:
        return None
    row = source.text[span.start : span.end].split("\n")[0]
    name = str(diagnostic.facts.get("name") or "")
    words = list(_WORD.finditer(row))
    found = next((word for word in words if word[0] == name), words[0] if words else None)
    if found is None or found[0] == new:
        return None
    return Fix(source.position(span.start).column - 1 + found.start(), found[0], str(new))
