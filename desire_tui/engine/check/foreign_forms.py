"""Derivatives as other tools write them, `d/dt(x) = …` and `x' = …`: understood, the book's form is shown."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import Diagnostic
from desire_tui.engine.nodes.segment import Derivative, VectorDerivative
from desire_tui.engine.source import Span

if TYPE_CHECKING:
    from collections.abc import Iterator

    from desire_tui.engine.nodes.program import Program

_SOMEWHERE = re.compile(r"d/dt[ \t]*\(|['\u2018\u2019\u201a\u201b\u2032][ \t]*=")
_FOREIGN = re.compile(r"((?:[A-Za-z]+[ \t]+)?d/dt)[ \t]*\(|[^=]*['\u2018\u2019\u201a\u201b\u2032][ \t]*=")


def foreign_forms(program: Program) -> Iterator[Diagnostic]:
    """Yield a warning for each derivative that the book would write with `d/dt` alone."""
    source = program.source
    text = source.text  # four searches for characters take a tenth of one for a pattern
    if text.isascii() and not any(sign in text for sign in ("'", "d/dt(", "d/dt (")):
        return
    if not _SOMEWHERE.search(text):
        return
    for segment in program.segments:
        for placed in segment.body:
            node = placed.node
            if not isinstance(node, Derivative | VectorDerivative):
                continue
            found = _FOREIGN.match(source.text, placed.at + node.start)
            if found is None:
                continue
            target = node.target if isinstance(node, Derivative) else None
            span = placed.span()
            name = source.text[placed.at + target.start : placed.at + target.end] if target else ""
            form = found[1] or "d/dt"
            facts = {"form": f"{form} {name.strip('() ') or getattr(node, 'name', '')}"}
            head = Span(span.start, source.text.index("=", span.start))
            yield Diagnostic("derivative-spelling", head, facts, source, "warning")
