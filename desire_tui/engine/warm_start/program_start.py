"""One start of a large program: restored from what an earlier process stored, or noted for a later one."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.gc_pause import undisturbed_allocation
from desire_tui.engine.lowered.deferred_segment import DeferredSegment
from desire_tui.engine.structure.structure import structure as find_structure
from desire_tui.engine.syntax.parse import parse
from desire_tui.engine.syntax.parsed_lines import knows
from desire_tui.engine.values import SCALAR_SLOTS, Values
from desire_tui.engine.warm_start import start_file
from desire_tui.engine.warm_start.program_facts import ProgramFacts, program_facts, restored_program
from desire_tui.engine.warm_start.segment_facts import (
    SegmentFacts,
    layout_after,
    layout_digest,
    restored_segment,
    segment_facts,
)

if TYPE_CHECKING:
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.nodes.program import Program
    from desire_tui.engine.runtime.backend import Model
    from desire_tui.engine.source import Source
    from desire_tui.engine.structure.structure import Structure
    from desire_tui.engine.values import Layout
    from desire_tui.engine.warm_start.start_file import Data

_SEGMENTS_MOST = 4
"""Of a program, in its file."""


class ProgramStart:
    """A program as it starts in this process. Belongs to the session's thread."""

    def __init__(self, source: Source, file: str) -> None:
        self._file = file
        self._facts: ProgramFacts | None = None
        self._segments: list[tuple[SegmentFacts, Data]] = []
        """What is stored of segments, with what their models noted."""
        self._lowered: dict[int, tuple[Segment, int | None, Layout, Layout]] = {}
        """Segments lowered in this process, by their ids: rule, names before and after that."""
        self._states: tuple[str, ...] | None = None
        self.own = self._restored(source) or _parsed(source)
        """The program and its structure."""

    def _restored(self, source: Source) -> tuple[Program, Structure] | None:
        stored = start_file.read(self._file)
        if stored is None:
            return None
        try:
            program, segments = stored
            facts = ProgramFacts(*program)
            found = [(SegmentFacts(*segment), noted) for segment, noted in segments]
        except (TypeError, ValueError):
            return None
        self._facts, self._segments, self._states = facts, found, facts.states
        return restored_program(facts, source)

    def states(self) -> tuple[str, ...]:
        """Return the names of the program's scalar states in their order."""
        if self._states is None:
            from desire_tui.engine.check.state_order import state_order

            self._states = state_order(self.own[0])
        return self._states

    @undisturbed_allocation
    def lowered(
        self, program: Program, label: str | None, values: Values, structure: Structure, rule: int | None
    ) -> Segment:
        """Return a segment as `lowering.lower` does, perhaps without its statements. DesireError."""

        def lower_with(names: Values) -> Segment:
            from desire_tui.engine.lowering.lowering import lower

            return lower(program, label, names, structure, rule)

        if program is not self.own[0] or values.times_of_files:
            return lower_with(values)
        before = values.layout()
        known = self._known(label, rule, before, values)
        if known is None:
            made = lower_with(values)
            if len(self._lowered) < _SEGMENTS_MOST:
                self._lowered[id(made)] = made, rule, before, values.layout()
            return made
        facts, noted = known
        values.lay_out(layout_after(facts, before))

        def lower_again() -> Segment:
            then = Values(before.arrays - SCALAR_SLOTS)  # names and numbers as they were
            then.lay_out(before)
            for slot, value in facts.constants:
                then.cells[slot] = value
            return lower_with(then)

        return DeferredSegment.of(restored_segment(facts, program.source), lower_again, noted)

    def keep(self, segment: Segment, model: Model) -> None:
        """Store a segment that has run, with what its model notes, for the next process."""
        lowered = self._lowered.pop(id(segment), None)
        if lowered is None:
            return
        note = getattr(model, "noted", None)
        noted: Data | None = note() if note is not None else None
        if noted is None:
            return
        if self._facts is None:
            self._facts = program_facts(*self.own, self.states())
        facts = segment_facts(*lowered)
        if self._facts is None or facts is None:
            return
        self._segments = [*self._segments[1 - _SEGMENTS_MOST :], (facts, noted)]
        segments = tuple((tuple(facts), tuple(noted)) for facts, noted in self._segments)
        start_file.write(self._file, (tuple(self._facts), segments))

    def _known(
        self, label: str | None, rule: int | None, before: Layout, values: Values
    ) -> tuple[SegmentFacts, Data] | None:
        """Return what is stored of a segment that was lowered with the same names and numbers."""
        if not self._segments:
            return None
        wanted, cells = (label, rule, layout_digest(before)), values.cells
        for facts, noted in self._segments:
            holds = all(cells[slot] == value for slot, value in facts.constants)
            if holds and wanted == (facts.label, facts.rule, facts.before):
                return facts, noted
        return None


def program_start(source: Source) -> ProgramStart | None:
    """Return the start of a program; None: it is known to this process, or nothing may be stored."""
    if knows(source.text):
        return None
    file = start_file.name_of(source.text)
    return None if file is None else ProgramStart(source, file)


def _parsed(source: Source) -> tuple[Program, Structure]:
    program = parse(source)
    return program, find_structure(program)
