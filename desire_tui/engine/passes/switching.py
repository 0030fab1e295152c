"""Where a segment's derivatives switch, for rules that control their steps.

A jump whose argument depends on states becomes a *mode*: the derivative pass reads a number that stays what
it is while a step lasts (the derivatives are smooth there), and a pass of its own computes what it would be
now. A jump or kink whose argument depends on t alone is a *clock*: it stays as it is, and steps end where
it switches. `term` is a mode that only has to be located. Kinks by states are left to error control.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import replace
from desire_tui.engine.lowered.effects import count_draws, expressions, role, writes
from desire_tui.engine.lowered.expressions import Const, Load, Op, Table1, Table2
from desire_tui.engine.lowered.statements import Deriv, DerivVec, Guard, Set, SetMat, SetVec, Terminate
from desire_tui.engine.lowered.switching import JUMPS, KINKS, Mode, ModeSlots, Switching, has_bounds
from desire_tui.engine.lowered.walk import simple_actions, walk_actions, walk_values
from desire_tui.engine.passes.affine import Affinity
from desire_tui.engine.passes.clearance import moving_slots
from desire_tui.engine.passes.dead_code import without_dead_code
from desire_tui.engine.passes.dependence import Dependence, Dependences
from desire_tui.engine.passes.slices import derivative_slice
from desire_tui.engine.passes.slot_set import SlotSet
from desire_tui.engine.passes.watch_passes import assignment, end_pass, stage_pass

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.segment import Event, Segment
    from desire_tui.engine.lowered.statements import Action, SimpleAction, Where

_SWITCHES = JUMPS | KINKS
_COMPOSED = ("ceil", "heav", "mod")
"""Functions that `lowering.operators` makes of jumps."""
_WORDS = (*sorted(JUMPS | KINKS), *_COMPOSED, "func1", "term", "if", "<", ">", "event")
"""A program whose text holds none of these switches nowhere: long ones need not be searched further."""


def switching(segment: Segment, allocate: Callable[[int], int]) -> tuple[Segment, Switching | None]:
    """Return the segment that is integrated between switchings, and what switches; None: nothing does.

    `allocate(count)` gives the first of `count` slots.
    """
    text = segment.source.text
    if not any(word in text for word in _WORDS) or not (segment.events or _may_switch(segment)):
        return segment, None
    finder = _Finder(segment)
    room = finder.room()
    if room == 0 and not finder.clocks:
        return segment, None
    slots = ModeSlots.from_slot(allocate(ModeSlots.ROWS * max(room, 1)), room)
    rewriter = _Rewriter(finder, slots)
    body = rewriter.body(segment.body)
    modes, live = tuple(rewriter.modes), rewriter.live_pass()
    moving = moving_slots(segment, rewriter.jumps, finder.dependences.definitions)
    return replace(segment, body=body), Switching(
        modes, slots, live, stage_pass(live, modes, slots), end_pass(live, modes, slots),
        tuple(finder.clocks), finder.dependences.definitions, tuple(rewriter.jumps) if moving else (), moving,
    )  # fmt: skip


def _may_switch(segment: Segment) -> bool:
    """Whether there is any statement or operation that can: quicker than to find what does."""
    for action in walk_actions(segment.body):
        if isinstance(action, Guard | Terminate):
            return True
        for node in walk_values(*expressions(action)):
            if isinstance(node, Table1) or (isinstance(node, Op) and node.name in _SWITCHES):
                return True
    return False


class _Finder:
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


class _Rewriter:
    """Writes the segment's body over frozen modes, and the pass that computes them."""

    def __init__(self, finder: _Finder, slots: ModeSlots) -> None:
        self._finder = finder
        self._slots = slots
        self._used = 0
        self.modes: list[Mode] = []
        self.jumps: list[Op] = []
        self._pass: list[Action] = []
        self._kept: set[int] = set()
        self._known: dict[int, tuple[Value, Value, Value]] = {}

    def live_pass(self) -> tuple[Action, ...]:
        """Return what computes the modes as they are now."""
        return without_dead_code(tuple(self._pass), frozenset(self._kept))

    def body(self, actions: Iterable[Action]) -> tuple[Action, ...]:
        """Rewrite a segment's statements; conditions of events stay what they are."""
        made = self._actions(actions, self._pass, in_step=False)
        for event in self._finder.segment.events:
            self._known.clear()
            for jump in self._finder.jumps_of_event(event):
                self._value(jump, None, self._pass, event.where)
        return made

    def _actions(self, actions: Iterable[Action], live: list[Action], *, in_step: bool) -> tuple[Action, ...]:
        made: list[Action] = []
        for action in actions:
            self._known.clear()  # an expression means something only within its statement
            if isinstance(action, Guard):
                made.append(self._guard(action, live, in_step=in_step))
            elif isinstance(action, Terminate):
                made.append(action)
                if is_located(action):
                    given = excess(action)
                    self._mode("swtch", given, self._value(given, action, live)[1], "term", action.where,
                               live, rising=True)  # fmt: skip
            elif id(action) in self._finder.derivative and not in_step:
                made.append(self._statement(action, live))
            else:
                made.append(action)
                if not in_step:
                    self._define(action, live)
        return tuple(made)

    def _guard(self, guard: Guard, live: list[Action], *, in_step: bool) -> Guard:
        if guard.kind not in {"if", "step"}:
            return guard
        inner = in_step or guard.kind == "step"
        if guard.kind == "step":
            body = self._actions(guard.body, live, in_step=True)
            return Guard(guard.kind, body, guard.where, guard.condition, guard.orelse, guard.every)
        assert guard.condition is not None
        frozen, now = guard.condition, guard.condition
        if self._finder.is_watched(guard, in_step=in_step):
            frozen, now = self._value(guard.condition, None, live, guard.where)
            if self._finder.needs_mode(guard.condition):
                frozen, now = self._mode("swtch", guard.condition, now, "if", guard.where, live)
        then: list[Action] = []
        other: list[Action] = []
        body = self._actions(guard.body, then, in_step=inner)
        orelse = self._actions(guard.orelse, other, in_step=inner)
        live.append(Guard("if", tuple(then), guard.where, now, tuple(other), guard.every))
        return Guard("if", body, guard.where, frozen, orelse, guard.every)

    def _define(self, action: SimpleAction, live: list[Action]) -> None:
        """Let the live pass compute a definition; states are not its to set."""
        if role(action) == "definition" and not any(
            self._finder.states.overlaps(*piece) for piece in writes(action)
        ):
            live.append(action)

    def _mode(
        self,
        operation: str,
        given: Value,
        argument: Value,
        name: str,
        where: Where,
        live: list[Action],
        *,
        rising: bool = False,
        action: SimpleAction | None = None,
    ) -> tuple[Value, Value]:
        """Add a mode of an argument, `given` as the program has it; return it frozen and live."""
        slots, scalar = self._slots, is_scalar(given)  # an array of one element is an array
        count = 1 if scalar or action is None else extent(action, given)
        mode = Mode(
            self._used, count, name, operation, where, self._finder.affinity.is_affine(given), scalar, rising
        )
        self._used += count
        self.modes.append(mode)
        self.jumps.append(Op(operation, (given,)))
        found = mode.at(slots.arguments)
        made = assignment(mode, slots.live, Op(operation, (found,)))
        live.append(_argument(mode, slots.arguments, argument, action))
        live.append(made)
        self._kept.add(id(made))
        return mode.at(slots.frozen), mode.at(slots.live)

    def _statement(self, action: SimpleAction, live: list[Action]) -> SimpleAction:
        def both(value: Value) -> tuple[Value, Value]:
            return self._value(value, action, live)

        if not any(
            isinstance(node, Op) and node.name in JUMPS and self._finder.is_mode(node)
            for node in walk_values(*expressions(action))
        ):
            self._define(action, live)
            return action
        match action:
            case Set():
                frozen, now = both(action.value)
                self._define(Set(action.slot, now, action.where, action.persistent), live)
                return Set(action.slot, frozen, action.where, action.persistent)
            case Deriv():
                return Deriv(action.state, both(action.value)[0], action.where)
            case DerivVec():
                return DerivVec(action.state, action.count, both(action.value)[0], action.where)
            case SetVec():
                frozen, now = both(action.value)
                first, second = (
                    SetVec(action.slot, action.count, value, action.where, action.mode, action.mask_slot,
                           action.persistent)
                    for value in (frozen, now)
                )  # fmt: skip
                self._define(second, live)
                return first
            case SetMat():
                frozen, now = both(action.value)
                first_matrix, second_matrix = (
                    SetMat(action.slot, action.rows, action.cols, value, action.where, action.mode,
                           action.lower, action.upper, action.mask_slot, action.persistent)
                    for value in (frozen, now)
                )  # fmt: skip
                self._define(second_matrix, live)
                return first_matrix
            case _:
                self._define(action, live)
                return action

    def _value(
        self, value: Value, action: SimpleAction | None, live: list[Action], where: Where | None = None
    ) -> tuple[Value, Value]:
        """Return an expression over frozen and over live modes; its own modes are added."""
        known = self._known.get(id(value))
        if known is None:
            place = where if where is not None else action.where if action is not None else None
            assert place is not None
            known = self._known[id(value)] = (value, *self._write(value, action, live, place))
        return known[1:]

    def _write(
        self, value: Value, action: SimpleAction | None, live: list[Action], where: Where
    ) -> tuple[Value, Value]:
        if isinstance(value, Table1):
            frozen, now = self._value(value.x, action, live, where)
            if frozen is value.x:
                return value, value
            return Table1(frozen, value.slot, value.count), Table1(now, value.slot, value.count)
        if not isinstance(value, Op):
            return value, value
        pairs = [self._value(argument, action, live, where) for argument in value.args]
        frozen_args, live_args = (tuple(pair[i] for pair in pairs) for i in (0, 1))
        same = all(pair[0] is argument for pair, argument in zip(pairs, value.args, strict=True))
        if value.name not in JUMPS or not self._finder.is_mode(value):
            return (value, value) if same else (Op(value.name, frozen_args), Op(value.name, live_args))
        operation = "swtch" if value.name == "comp" else value.name
        inside, outside = self._mode(
            operation, value.args[0], live_args[0], value.name, where, live, action=action
        )
        if value.name != "comp":
            return inside, outside
        half = Const(0.5)
        return (
            Op("comp", (Op("sub", (inside, half)), *frozen_args[1:])),
            Op("comp", (Op("sub", (outside, half)), *live_args[1:])),
        )


def _argument(mode: Mode, row: int, value: Value, action: SimpleAction | None) -> Action:
    """Return the statement that computes a mode's argument as `action` would."""
    if isinstance(action, SetMat) and not mode.is_scalar:
        return SetMat(row + mode.first, action.rows, action.cols, value, mode.where)
    return assignment(mode, row, value)
