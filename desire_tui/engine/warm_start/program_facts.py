"""What is stored of a parsed program: where its script ends, its segments' labels, its states' order."""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

from desire_tui.engine.nodes.deferred_text import DeferredSegmentText
from desire_tui.engine.nodes.program import Program, SegmentText
from desire_tui.engine.source import Source
from desire_tui.engine.structure.structure import Structure, structure
from desire_tui.engine.syntax.parse import parse


class ProgramFacts(NamedTuple):
    """Plain data."""

    script: int
    """The script's length in the text."""
    segments: tuple[tuple[str | None, int], ...]
    """Labels and places of the segments."""
    states: tuple[str, ...]
    """Names of the scalar states in their order (`check.state_order`)."""


def program_facts(program: Program, found: Structure, states: tuple[str, ...]) -> ProgramFacts | None:
    """Return what restores a program and its structure; None: nothing does so exactly."""
    if not program.segments:
        return None
    first = program.segments[0].at
    places = tuple((segment.label, segment.at) for segment in program.segments)
    facts = ProgramFacts(program.source.text.rfind("\n", 0, first) + 1, places, states)
    again, found_again = restored_program(facts, program.source)
    fields = ("script", "problems", "lines", "faults")
    is_same = all(getattr(again, field) == getattr(program, field) for field in fields)
    return facts if is_same and found_again == found else None


def restored_program(facts: ProgramFacts, source: Source) -> tuple[Program, Structure]:
    """Return a program whose script is parsed now, and its segments when somebody wants them."""
    script = parse(Source(source.text[: facts.script])).script
    whole: list[Program] = []

    def segment(number: int) -> SegmentText:
        if not whole:
            whole.append(parse(source))
        return whole[0].segments[number]

    segments = [
        DeferredSegmentText(label, at, partial(segment, number))
        for number, (label, at) in enumerate(facts.segments)
    ]
    without_blocks = tuple(SegmentText(label, (), (), at) for label, at in facts.segments)
    found = structure(Program(source, script, without_blocks))  # to which only segments' blocks would add
    return Program(source, script, tuple(segments)), found
