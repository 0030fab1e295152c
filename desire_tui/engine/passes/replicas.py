"""Vector models whose elements go their ways alone: replicas of a scalar model (Korn's model replication).

Element i of every vector depends on elements i of others, on parameters and on t. Then a step can be taken
for some replicas after the others, all its stages while their numbers are in registers.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.lowered.effects import count_draws, memory, reads, writes
from desire_tui.engine.lowered.expressions import Const, Load, Op, Table1, Table2, Vec
from desire_tui.engine.lowered.statements import Deriv, DerivVec, Set, SetVec
from desire_tui.engine.lowered.walk import walk_actions
from desire_tui.engine.passes.slot_set import SlotSet

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.segment import StateRange
    from desire_tui.engine.lowered.statements import Action

_STATEMENTS_MOST = 200


class ReplicatedModel(NamedTuple):
    """The model of one replica, whose number of a vector is known by the vector's first slot."""

    replicas: int
    statements: tuple[Set | Deriv, ...]
    """Of the derivative pass. A Deriv's number is that of a vector of states."""
    states: tuple[int, ...]
    """Vectors of states."""
    numbers: tuple[int, ...]
    """Of the first state in each of them."""
    read: frozenset[int]
    """Vectors that are read before they are assigned, states not among them."""
    assigned: frozenset[int]
    """Vectors that are assigned before they are read."""
    scalars: frozenset[int]
    """Slots that all replicas share."""


def replicated(
    passes: Mapping[str, tuple[Action, ...]], states: Sequence[StateRange]
) -> ReplicatedModel | None:
    """Return the model of one replica; None: there is none, or steps do more than compute derivatives."""
    counts = {states.count for states in states}
    if len(counts) != 1 or 1 in counts:  # nothing to replicate: the passes need not be made
        return None
    actions = passes["derivative"]
    if not 0 < len(actions) <= _STATEMENTS_MOST:
        return None
    if tuple(map(id, passes["step"])) != tuple(map(id, actions)) or passes["tail"]:
        return None
    (replicas,) = counts
    scan = _Scan(replicas, states)
    statements = [scan.statement(action) for action in actions]
    found = [statement for statement in statements if statement is not None]
    if len(found) < len(statements) or not scan.is_consistent():
        return None
    if _reads_early(passes["full"], scan):
        return None
    numbers = {statement.state for statement in found if isinstance(statement, Deriv)}
    if numbers != set(range(len(states))) or sum(isinstance(s, Deriv) for s in found) != len(states):
        return None
    return ReplicatedModel(
        replicas, tuple(found), tuple(scan.states), tuple(piece.first for piece in states),
        frozenset(scan.read), frozenset(scan.assigned), frozenset(scan.scalars),
    )  # fmt: skip


class _Scan:
    """Goes through a pass once."""

    def __init__(self, replicas: int, states: Sequence[StateRange]) -> None:
        self.replicas = replicas
        self.states = [piece.slot for piece in states]
        self._numbers = {piece.first: number for number, piece in enumerate(states)}
        self.read, self.assigned, self.scalars = set[int](), set[int](), set[int]()
        self._late = set[int]()
        """Scalars read before they are assigned, in case they are."""
        self.scalars_set = set[int]()
        self._known: dict[int, Value] = {}
        self._tables = SlotSet()

    def statement(self, action: Action) -> Set | Deriv | None:
        """Return a statement for one replica; None: it has none."""
        match action:
            case Set():
                value = self._value(action.value, over_elements=False)
                if value is None:
                    return None
                self.scalars_set.add(action.slot)
                self.scalars.add(action.slot)
                return Set(action.slot, value, action.where)
            case SetVec(mode="set", mask_slot=None) if action.count == self.replicas:
                value = self._value(action.value, over_elements=True)
                if value is None or action.slot in self.states:
                    return None
                self.assigned.add(action.slot)
                return Set(action.slot, value, action.where)
            case DerivVec() if action.count == self.replicas and action.state in self._numbers:
                value = self._value(action.value, over_elements=True)
                return None if value is None else Deriv(self._numbers[action.state], value, action.where)
            case _:
                return None

    def _value(self, node: Value, *, over_elements: bool) -> Value | None:
        if count_draws(node):
            return None
        return self._one(node, over_elements=over_elements)

    def _one(self, node: Value, *, over_elements: bool) -> Value | None:
        """Return what a replica computes; an object met again is the same object."""
        known = self._known.get(id(node))
        if known is None:
            known = self._made(node, over_elements=over_elements)
            if known is None:
                return None
            self._known[id(node)] = known
        return known

    def _made(self, node: Value, *, over_elements: bool) -> Value | None:
        match node:
            case Const():
                return node
            case Load():
                self.scalars.add(node.slot)
                if node.slot not in self.scalars_set:
                    self._late.add(node.slot)
                return node
            case Vec() if over_elements and node.count == self.replicas:
                if node.slot not in self.states and node.slot not in self.assigned:
                    self.read.add(node.slot)
                return Load(node.slot)
            case Op():
                args = [self._one(arg, over_elements=over_elements) for arg in node.args]
                whole = tuple(arg for arg in args if arg is not None)
                return Op(node.name, whole) if len(whole) == len(args) else None
            case Table1():
                self._note_tables(node)
                x = self._one(node.x, over_elements=over_elements)
                return None if x is None else Table1(x, node.slot, node.count)
            case Table2():
                self._note_tables(node)
                x = self._one(node.x, over_elements=over_elements)
                y = self._one(node.y, over_elements=over_elements)
                if x is None or y is None:
                    return None
                return Table2(x, y, node.f_slot, node.rows, node.cols, node.x_slot, node.y_slot)
            case _:
                return None

    def _note_tables(self, node: Table1 | Table2) -> None:
        for slot, count in memory(node):
            self._tables.add(slot, count)

    def is_consistent(self) -> bool:
        """Whether vectors overlap nothing, and nothing is carried from one pass to the next."""
        changed = SlotSet()
        for slot in (*self.states, *self.assigned):
            if changed.overlaps(slot, self.replicas):
                return False
            changed.add(slot, self.replicas)
        others = [(slot, self.replicas) for slot in self.read] + [(slot, 1) for slot in self.scalars]
        if any(changed.overlaps(slot, count) for slot, count in others):
            return False
        if any(self._tables.overlaps(slot, self.replicas) for slot in (*self.states, *self.assigned)):
            return False
        return self._late.isdisjoint(self.scalars_set)


def _reads_early(actions: Iterable[Action], scan: _Scan) -> bool:
    """Whether a pass reads what derivatives assign before it has assigned it."""
    missing = {slot: slot + scan.replicas for slot in scan.assigned}
    missing |= {slot: slot + 1 for slot in scan.scalars_set}
    for action in actions:
        for inner in walk_actions((action,)):
            for slot, count in reads(inner):
                if any(slot < end and first < slot + count for first, end in missing.items()):
                    return True
        for slot, count in writes(action):
            if missing.get(slot, -1) == slot + count:
                del missing[slot]
    return False
