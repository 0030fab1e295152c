"""Draw a diagnostic: one shape for command pane, problem list and headless runner (language.md 14).

    step.src:4:12: error 200: undefined variable 'xdto'
        y = 2 * xdto
                ^^^^
    hint: did you mean 'xdot'?

Plain text; a caller that wants colour colours it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING
from unicodedata import category, combining, east_asian_width

from desire_tui.engine.visible_text import visible, visible_line

if TYPE_CHECKING:
    from collections.abc import Iterable

    from desire_tui.engine.diagnostics.diagnostic import Diagnostic
    from desire_tui.engine.source import Source, Span

INDENT = "    "
TAB_STOP = 4
COLUMNS_MAX = 100
"""Longer lines are shown as a window around the span."""
CONTEXT = 30
"""Columns kept before the span in such a window."""


def render(diagnostic: Diagnostic) -> str:
    """Return the message, its source line with carets, and the hint, as lines without a trailing newline."""
    lines = [f"{_place(diagnostic)}{diagnostic.severity} {diagnostic.code}: {visible(diagnostic.message)}"]
    if diagnostic.source is not None and diagnostic.span is not None:
        lines += _frame(diagnostic.source, diagnostic.span)
    hint = diagnostic.hint
    if hint:
        lines.append(f"hint: {visible(hint)}")
    for other in diagnostic.related:
        lines.append(f"{_place(other)}note: {visible(other.message)}")
        if other.source is not None and other.span is not None:
            lines += _frame(other.source, other.span)
    return "\n".join(lines)


def render_all(diagnostics: Iterable[Diagnostic]) -> str:
    """Return several messages, one blank line between them."""
    return "\n\n".join(render(diagnostic) for diagnostic in diagnostics)


def _place(diagnostic: Diagnostic) -> str:
    source, span = diagnostic.source, diagnostic.span
    if source is None:
        return ""
    name = visible_line(source.name)
    if span is None:
        return f"{name}: "
    row, column = source.position(span.start)
    return f"{name}:{row}:{column}: "


def _frame(source: Source, span: Span) -> list[str]:
    """Return the line on which the span starts, and carets under as much of it as stands there."""
    row, column = source.position(span.start)
    line = source.line(row)
    start = min(column - 1, len(line))
    end = max(start, min(len(line), start + span.end - span.start))
    before, inside = _drawn(line[:start], 0), ""
    inside = _drawn(line[start:end], _width(before))
    after = _drawn(line[end : end + COLUMNS_MAX], _width(before) + _width(inside))
    before, inside, after = _window(before, inside, after)
    carets = " " * _width(before) + "^" * max(1, _width(inside))
    return [f"{INDENT}{before}{inside}{after}".rstrip(), f"{INDENT}{carets}"]


def _window(before: str, inside: str, after: str) -> tuple[str, str, str]:
    """Cut the three parts of a line so that together they fit into COLUMNS_MAX columns."""
    if _width(before) + _width(inside) + _width(after) <= COLUMNS_MAX:
        return before, inside, after
    if _width(before) > CONTEXT and _width(before) + _width(inside) > COLUMNS_MAX - 10:
        before = "…" + before[-CONTEXT:]
    room = COLUMNS_MAX - _width(before)
    if _width(inside) > room - 1:
        return before, inside[: max(1, room - 1)] + "…", ""
    room -= _width(inside)
    return before, inside, after if _width(after) <= room else after[: max(0, room - 1)] + "…"


def _drawn(text: str, column: int) -> str:
    """Return what a terminal can show: tabs expanded from `column` on, control characters visible."""
    if text.isascii() and text.isprintable():
        return text
    out = []
    for char in visible(text):
        drawn = " " * (TAB_STOP - column % TAB_STOP) if char == "\t" else char
        out.append(drawn)
        column += _width(drawn)
    return "".join(out)


def _width(text: str) -> int:
    """Terminal columns that the text takes."""
    if text.isascii():
        return len(text)
    return sum(
        0 if combining(char) or category(char) in {"Mn", "Me"} else 2 if east_asian_width(char) in "WF" else 1
        for char in text
    )
