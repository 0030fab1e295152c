"""Problems of a segment's statements, at their places in the text."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import Diagnostic

if TYPE_CHECKING:
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.statements import Where


def at_statement(key: str, facts: dict[str, object], segment: Segment, where: Where | None) -> Diagnostic:
    """Return a problem of a segment's statement; one in a submodel's body names the invocation too."""
    related: tuple[Diagnostic, ...] = ()
    if where is not None and where.invoked_at is not None:
        related = (Diagnostic("expanded-here", where.invoked_at, {}, segment.source),)
    span = where.span if where is not None else None
    return Diagnostic(key, span, facts, segment.source, related=related)
