"""A whole program: placed statements, segments."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.data_classes import dataclass, field
from desire_tui.engine.nodes.record import node
from desire_tui.engine.source import Source, Span

if TYPE_CHECKING:
    from collections.abc import Mapping

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

    `faults` are those of its `problems` that belong to a `Faulty` statement, by its offset: they stop a
    program that gets there. The others (`unreadable`) stop it at once: nobody knows what the text was to be.
    """

    source: Source
    script: tuple[Placed, ...]
    segments: tuple[SegmentText, ...]
    problems: tuple[Diagnostic, ...] = ()
    lines: tuple[tuple[int, int], ...] = ()
    """Numbers of lines and where they begin, if the script jumps to any by its number."""
    faults: Mapping[int, Diagnostic] = field(default_factory=dict)

    @property
    def unreadable(self) -> tuple[Diagnostic, ...]:
        """Problems with text that is no statement at all."""
        waiting = {id(fault) for fault in self.faults.values()}
        return tuple(p for p in self.problems if p.severity == "error" and id(p) not in waiting)

    def segment(self, label: str | None) -> SegmentText | None:
        """Return the unlabelled segment (None) or the one with that label."""
        for segment in self.segments:
            if segment.label == label:
                return segment
        return None
