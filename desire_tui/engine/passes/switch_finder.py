"""Finds what switches in a segment: jumps by states, `term`, clocks, and what events decide by."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.lowered.effects import count_draws, expressions
from desire_tui.engine.lowered.expressions import Const, Load, Op, Table1, Table2
from desire_tui.engine.lowered.statements import DerivVec, Guard, SetMat, SetVec, Terminate
from desire_tui.engine.lowered.switching import JUMPS, KINKS, has_bounds
from desire_tui.engine.lowered.walk import simple_actions, walk_values
from desire_tui.engine.passes.affine import Affinity
from desire_tui.engine.passes.dependence import Dependence, Dependences
from desire_tui.engine.passes.slices import derivative_slice
from desire_tui.engine.passes.slot_set import SlotSet

if TYPE_CHECKING:
    from collections.abc import Iterable

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.segment import Event, Segment
    from desire_tui.engine.lowered.statements import Action, SimpleAction, Where


class SwitchFinder:
    """What switches: jumps by states among the statements of derivative passes, `term`, clocks."""

    def __init__(self, segment: Segment) -> None:
        self.segment = segment
        actions = derivative_slice(segment)
        self.dependences = Dependences(actions, segment.states, has_bounds)
        self.derivative = {id(action) for action in simple_actions(actions)}
        self.clocks: list[tuple[Value, Where]] = []
        self.affinity = Affinity(self.dependences, segment.states)
        self.states = SlotSet()
        for given in segment.states:
            self.states.add(given.slot, given.count)

    def room(self) -> int:
        """Count the modes, and collect the clocks, events whose expression depends on t alone among them."""
        for event in self.segment.events:
            if event.condition is not None and self.dependences.of(event.condition) is Dependence.TIME:
                kink = Op("lim", (event.condition,))  # a jump only where the block makes one
                self.clocks.append((kink, event.where))
        inside = sum(len(self.jumps_of_event(event)) for event in self.segment.events)
        return inside + self._room(self.segment.body, in_step=False)

    def jumps_of_event(self, event: Event) -> list[Op]:
        """Return what jumps by states in an event's condition, `x > 1 and y < 2`: a step ends at each."""
        nodes = walk_values(event.condition) if event.condition is not None else ()
        return [node for node in nodes if isinstance(node, Op) and node.name in JUMPS and self.is_mode(node)]

    def _room(self, actions: Iterable[Action], *, in_step: bool) -> int:
        found = 0
        for action in actions:
            if isinstance(action, Guard):
                if action.kind not in {"if", "step"}:
                    continue
                inner = in_step or action.kind == "step"
                if self.is_watched(action, in_step=in_step):
                    assert action.condition is not None
                    found += self._condition(action.condition, action.where)
                found += self._room(action.body, in_step=inner) + self._room(action.orelse, in_step=inner)
            elif isinstance(action, Terminate):
                if is_located(action):
                    found += 1 + self._condition(excess(action), action.where)
            elif id(action) in self.derivative and not in_step:
                for node in walk_values(*expressions(action)):
                    found += self._node(node, action.where, action)
        return found

    def is_watched(self, guard: Guard, *, in_step: bool) -> bool:
        """Whether an `if` decides about what derivatives read."""
        return (
            guard.kind == "if"
            and not in_step
            and guard.condition is not None
            and not count_draws(guard.condition)
            and any(id(inner) in self.derivative for inner in simple_actions((guard,)))
        )

    def _condition(self, condition: Value, where: Where) -> int:
        """Count the modes of a condition: what switches in it (`x > 1` is a jump itself), and its own."""
        depends = self.dependences.of(condition)
        if depends is Dependence.TIME:
            self.clocks.append((Op("swtch", (condition,)), where))
        if depends is not Dependence.STATES:
            return 0
        return 1 + sum(self._node(node, where) for node in walk_values(condition))

    def _node(self, node: Value, where: Where, action: SimpleAction | None = None) -> int:
        if isinstance(node, Table1):
            if self.dependences.of(node.x) is Dependence.TIME:
                self.clocks.append((node, where))
            return 0
        if not isinstance(node, Op):
            return 0
        if node.name in JUMPS and self.is_mode(node):
            return 1 if action is None else extent(action, node)
        decides = Op("swtch", node.args[:1]) if node.name == "comp" else node
        if node.name in JUMPS | KINKS and self.dependences.of(decides) is Dependence.TIME:
            self.clocks.append((decides, where))
        return 0

    def needs_mode(self, condition: Value) -> bool:
        """Whether a condition has to be frozen: one that is a jump itself already is."""
        if isinstance(condition, Op) and condition.name in JUMPS - {"comp"} and self.is_mode(condition):
            return False
        return self.dependences.of(condition) is Dependence.STATES

    def is_mode(self, node: Op) -> bool:
        """Whether a jump depends on states (and on nothing drawn)."""
        argument = node.args[0]
        return self.dependences.of(argument) is Dependence.STATES and not count_draws(argument)


def is_located(action: Terminate) -> bool:
    """Whether the place where a `term` fires can be found."""
    return action.fault is None and not count_draws(action.value)


def excess(action: Terminate) -> Value:
    """Return what is above 0 where a `term` ends the run."""
    return action.value if action.level is None else Op("sub", (action.value, Load(action.level)))


def is_scalar(node: Value) -> bool:
    """Whether nothing in an expression is an array."""
    return all(isinstance(part, Const | Load | Op | Table1 | Table2) for part in walk_values(node))


def extent(action: SimpleAction, node: Value) -> int:
    """Return the number of elements of a node in a statement: 1 where nothing in it is an array."""
    if is_scalar(node):
        return 1
    match action:
        case SetVec() | DerivVec():
            return action.count
        case SetMat():
            return action.rows * action.cols
        case _:
            return 1
