"""Variables computed from themselves above a derivative, `y = cos(y*x)`, that nothing gives a first value.

Such a line is a difference equation, not an equation that is solved: every pass moves it, and a rule makes
several passes in a step.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import Diagnostic
from desire_tui.engine.lowered.effects import reads, writes
from desire_tui.engine.lowered.expressions import Load, Op
from desire_tui.engine.lowered.statements import Deriv, DerivVec, Guard, Set
from desire_tui.engine.lowered.switching import JUMPS
from desire_tui.engine.lowered.walk import operands, walk_actions
from desire_tui.engine.passes.slot_set import SlotSet

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.statements import Action
    from desire_tui.engine.lowering.scope import SegmentScope


def recursions(segment: Segment, scope: SegmentScope) -> list[Diagnostic]:
    """Return a warning for each of them that a derivative reads."""
    found = [made for made in _in_every_pass(segment.body) if _moves(made)]
    if not found or not segment.order:
        return []
    read = _read_by_derivatives(segment.body)
    quantities = {q.slot: q for q in scope.names.values() if not q.shape}
    problems = []
    for made in found:
        quantity = quantities.get(made.slot)
        if quantity is None or scope.is_defined(quantity) or not read.overlaps(made.slot, 1):
            continue
        facts = {"name": quantity.name}
        problems.append(Diagnostic("recursion-undeclared", made.where.span, facts, segment.source, "warning"))
    return problems


def _moves(made: Set) -> bool:
    """Whether it reads itself, and not as a relay does: `p = 2*sgn(p - x)` keeps its value."""
    if (made.slot, 1) not in reads(made):
        return False
    rest, seen = [made.value], set[int]()
    while rest:
        node = rest.pop()
        if isinstance(node, Load) and node.slot == made.slot:
            return True
        if id(node) not in seen and not (isinstance(node, Op) and node.name in JUMPS):
            seen.add(id(node))
            rest.extend(operands(node))
    return False


def _in_every_pass(actions: Iterable[Action]) -> Iterator[Set]:
    for action in [action for action in actions if type(action) is Set or type(action) is Guard]:
        if isinstance(action, Set):
            yield action
        elif isinstance(action, Guard) and action.kind == "if":
            yield from _in_every_pass((*action.body, *action.orelse))


def _read_by_derivatives(body: tuple[Action, ...]) -> SlotSet:
    """Return what derivatives depend on, through other variables too."""
    read = SlotSet()
    for action in reversed(list(walk_actions(body))):
        is_derivative = isinstance(action, Deriv | DerivVec | Guard)
        if is_derivative or any(read.overlaps(*piece) for piece in writes(action)):
            for piece in reads(action):
                read.add(*piece)
    return read
