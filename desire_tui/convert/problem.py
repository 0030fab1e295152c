"""Problems with their place in the file."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import Diagnostic
from desire_tui.engine.diagnostics.wording import wording_of

if TYPE_CHECKING:
    from typing import Literal

    from desire_tui.engine.source import Source, Span

_SHOWN_MOST = 60
"""How many characters of the file a message repeats."""


def placed(
    source: Source,
    span: Span | None,
    key: Literal["convert-part", "convert-note"],
    what: str,
    reason: str,
) -> Diagnostic:
    """Return a problem: a part that is not taken over, or one that was taken over in another way."""
    flat = " ".join(what.split())
    short = flat if len(flat) <= _SHOWN_MOST else f"{flat[: _SHOWN_MOST - 1]}…"
    severity: Literal["warning", "error"] = "warning" if wording_of(key).warning else "error"
    return Diagnostic(key, span, {"what": short, "reason": reason}, source, severity)


def place(problem: Diagnostic) -> tuple[int, int]:
    """Return where a problem stands, to sort by."""
    return (problem.line or 0, problem.column or 0)
