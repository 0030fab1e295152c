"""What giving a quantity values in a study would not do: found before the first run.

A defined variable is computed anew by every pass of the segment: whatever it is given, all runs are the same.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.api.settings import slot_of
from desire_tui.engine.diagnostics import Diagnostic
from desire_tui.engine.lowered.effects import memory, reads, writes
from desire_tui.engine.lowered.statements import DelayLine, Guard, Set, SetDot, SetMat, SetVec
from desire_tui.engine.lowered.walk import walk_actions, walk_values
from desire_tui.engine.session.dependent_assignments import dependents
from desire_tui.engine.session.overrides import WORD, name_and_subscripts

if TYPE_CHECKING:
    from collections.abc import Iterable

    from desire_tui.api.instance import Instance
    from desire_tui.engine.lowered.effects import Piece
    from desire_tui.engine.lowered.segment import Segment

    Computed = Set | SetDot | SetVec | SetMat


def computed_anyway(names: Iterable[str], instance: Instance) -> list[Diagnostic]:
    """Return errors 517: quantities whose given value neither the script nor the segment of a run reads."""
    script, prepared = instance.prepared.script, instance.prepared
    problems = []
    for name in names:
        own, _ = name_and_subscripts(name)
        slot = slot_of(name, instance)
        if slot is None or dependents(*script, prepared.place, {own}) != []:
            continue
        is_scalar = not instance.session.values.names[own].shape
        if is_scalar and slot not in prepared.segment.scalars:
            continue
        action = _computes_first(prepared.segment, slot)
        if action is not None:
            problems.append(_problem(name, own, action, instance))
    return problems


def _computes_first(segment: Segment, slot: int) -> Computed | None:
    """Return the statement that assigns a slot in every pass, if nothing reads the slot before."""
    if _meets(_read_elsewhere(segment), slot):
        return None
    for action in segment.body:
        if any(_meets(reads(each), slot) for each in walk_actions((action,))):
            return None
        if isinstance(action, Guard) or not _meets(writes(action), slot):
            continue
        return action if isinstance(action, Set | SetDot | SetVec | SetMat) else None
    return None


def _read_elsewhere(segment: Segment) -> list[Piece]:
    """Return what is read before the first pass or aside from its order: how far delays reach."""
    values = [value for delay in segment.delays for value in (delay.source, delay.tau)]
    values += [action.tau for action in walk_actions(segment.body) if isinstance(action, DelayLine)]
    return [piece for node in walk_values(*values) for piece in memory(node)]


def _meets(pieces: Iterable[Piece], slot: int) -> bool:
    return any(first <= slot < first + length for first, length in pieces)


def _problem(name: str, own: str, action: Computed, instance: Instance) -> Diagnostic:
    source, span = instance.prepared.segment.source, action.where.span
    words = dict.fromkeys(WORD.findall(source.text[span.start : span.end]))
    read = [word for word in words if word != own and word in instance.session.values.names]
    remedy = (
        f"vary what it is computed from: {', '.join(read)}"
        if read
        else "take its line out of the DYNAMIC segment, and give it a value in the script"
    )
    return Diagnostic("study-computed", span, {"name": name, "remedy": remedy}, source)
