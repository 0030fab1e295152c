"""Writes a segment's body over frozen modes, and the pass that computes what they would be now."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.lowered.effects import expressions, role, writes
from desire_tui.engine.lowered.expressions import Const, Op, Table1
from desire_tui.engine.lowered.statements import Deriv, DerivVec, Guard, Set, SetMat, SetVec, Terminate
from desire_tui.engine.lowered.switching import JUMPS, Mode
from desire_tui.engine.lowered.walk import walk_values
from desire_tui.engine.passes.dead_code import without_dead_code
from desire_tui.engine.passes.switch_finder import excess, extent, is_located, is_scalar
from desire_tui.engine.passes.watch_passes import assignment

if TYPE_CHECKING:
    from collections.abc import Iterable

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.statements import Action, SimpleAction, Where
    from desire_tui.engine.lowered.switching import ModeSlots
    from desire_tui.engine.passes.switch_finder import SwitchFinder


class SwitchRewriter:
    """Writes the segment's body over frozen modes, and the pass that computes them."""

    def __init__(self, finder: SwitchFinder, slots: ModeSlots) -> None:
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
