"""Where `go to`, `exit` and `restore` lead, and the `if`s of DYNAMIC segments."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.cancellation import cancellation_point
from desire_tui.engine.diagnostics import closest
from desire_tui.engine.nodes.commands import Simple
from desire_tui.engine.nodes.control import GoTo, If, Label, Procedure
from desire_tui.engine.nodes.declarations import Submodel
from desire_tui.engine.nodes.faulty import Faulty
from desire_tui.engine.nodes.files import Restore
from desire_tui.engine.nodes.program import Placed, SegmentText

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.structure.blocks import BlockSurvey

_BLOCK_STATEMENTS = frozenset({Faulty, If, Simple})
"""Classes of what opens or closes an `if` of a segment."""


def check_jumps(survey: BlockSurvey, segments: set[str | None] | None) -> None:
    """Check where every `go to` and `restore` leads, and give every `exit` its loop's end."""
    found = survey.found
    for place, opener in found.exits.items():
        assert opener is not None
        is_loop = not isinstance(survey.statements[opener].node, (Procedure, Submodel))
        found.exits[place] = found.partner.get(opener) if is_loop else None
    if segments is None:
        return  # a command line may name what the program has
    for place, placed in enumerate(survey.statements):
        node = placed.node
        if isinstance(node, GoTo):
            _jump(survey, place, placed, node.target, segments)
        elif isinstance(node, Restore) and node.target and found.place(node.target) is None:
            _unknown(survey, placed, node.target)


def _unknown(survey: BlockSurvey, placed: Placed, target: str) -> None:
    known = map(str, survey.found.numbers) if target.isdigit() else survey.found.labels
    survey.report("no-such-label", placed, name=target, close=closest(target, known))


def _jump(survey: BlockSurvey, place: int, placed: Placed, target: str, segments: set[str | None]) -> None:
    to = survey.found.place(target)
    if to is None:
        if target in segments:
            survey.report("jump-to-segment", placed, name=target)
        else:
            _unknown(survey, placed, target)
        return
    block = survey.found.inside[to]
    if block >= 0 and block not in _around(survey, place):
        survey.report("jump-inside", placed, survey.also("block-begins", block), name=target)
        return
    for definition in _around(survey, place) - _around(survey, to):
        if isinstance(survey.statements[definition].node, Procedure):
            survey.report("jump-out", placed, survey.also("block-begins", definition), name=target)


def _around(survey: BlockSurvey, place: int) -> set[int]:
    """All blocks around a statement."""
    around = set()
    block = survey.found.inside[place]
    while block >= 0:
        around.add(block)
        block = survey.parents[block]
    return around


def match_segments(survey: BlockSurvey, segments: Sequence[SegmentText]) -> None:
    """Match `if`, `else`, `end if` in the segments; a label may name one segment only."""
    seen: dict[str | None, SegmentText] = {}
    for segment in segments:
        if segment.label is not None and (segment.label in seen or segment.label in survey.found.labels):
            start = Placed(Label(segment.label, 0, len("label ") + len(segment.label)), segment.at)
            key = "segment-label-twice" if segment.label in seen else "segment-label-in-script"
            survey.warn(key, start, name=segment.label)
        seen.setdefault(segment.label, segment)
        partner = survey.found.segment_partner.setdefault(segment.label, {})
        if seen[segment.label] is segment:
            _segment(survey, segment.body, partner)


def _segment(survey: BlockSurvey, body: Sequence[Placed], partner: dict[int, int]) -> None:
    opened: list[int] = []
    for place, placed in [pair for pair in enumerate(body) if type(pair[1].node) in _BLOCK_STATEMENTS]:
        cancellation_point()
        node = placed.node
        if isinstance(node, Faulty):
            if node.word == "if":
                opened.append(place)
            elif node.word in ("else", "end if", "proceed") and opened:
                opened.pop()
        elif isinstance(node, If):
            if node.condition is not None:
                survey.report("then-in-segment", placed)
            opened.append(place)
        elif isinstance(node, Simple) and node.word in ("else", "end if", "proceed"):
            if not opened:
                survey.report("stray-else", placed, word=node.word)
                continue
            last = opened.pop()
            if node.word == "else" and isinstance(body[last].node, Simple):
                survey.report("second-else", placed)
            partner[last] = place
            if node.word == "else":
                opened.append(place)
            else:
                partner[place] = last
