"""A whole program: placed statements, segments."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.nodes.record import node
from desire_tui.engine.source import Source, Span

if TYPE_CHECKING:
    from desire_tui.engine.diagnostics import Diagnostic
    from desire_tui.engine.nodes.record import Node
    from desire_tui.engine.nodes.statements import Statement


class Placed(NamedTuple):
    """A statement, the offset of its raw text in the source, its line number if the file carries numbers."""

    node: Statement
    at: int
    number: int | None = None

    def span(self, part: Node | None = None) -> Span:
        """Place in the source of the statement or of a part of it."""
        part = part or self.node
        return Span(self.at + part.start, self.at + part.end)


@node
class SegmentText:
    """The statements of one DYNAMIC program segment; `jacobian` are those behind its JACOBIAN line."""

    label: str | None
    body: tuple[Placed, ...]
    jacobian: tuple[Placed, ...]
    at: int


@dataclass(frozen=True)
class Program:
    """A parsed program. `script` is flat: blocks are found by `structure.structure`.

    A program with `problems` can still be looked at (highlighting, completion), but not run.
    """

    source: Source
    script: tuple[Placed, ...]
    segments: tuple[SegmentText, ...]
    problems: tuple[Diagnostic, ...] = ()
    lines: tuple[tuple[int, int], ...] = ()
    """Numbers of lines and where they begin, if the script jumps to any by its number."""

    def segment(self, label: str | None) -> SegmentText | None:
        """Return the unlabelled segment (None) or the one with that label."""
        for segment in self.segments:
            if segment.label == label:
                return segment
        return None
