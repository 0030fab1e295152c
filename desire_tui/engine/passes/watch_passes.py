"""What tells at a step's end whether a mode may have switched in it, for rules without an interpolant.

Such a step is looked at on the parabola through its start, with the slope there, and its end. The parabola
lies within the triangle of its ends and of the point where their tangents meet, t + h/2 and x + h·x'/2: the
second stage of rules 4 and 8 (that of rule 7, t + h and x + h·x', makes a wider triangle). An affine argument
takes its largest and smallest values on the triangle's corners; what is constant between two thresholds is
the same all over the triangle if it is so there. Other arguments are given twice the room that they move in,
or must be three times as far from 0 as they have moved.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.lowered.effects import writes
from desire_tui.engine.lowered.expressions import Const, Op
from desire_tui.engine.lowered.statements import Guard, Set, SetMat, SetVec
from desire_tui.engine.lowered.switching import THRESHOLDS, Threshold
from desire_tui.engine.lowered.walk import with_bodies

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.statements import Action
    from desire_tui.engine.lowered.switching import Mode, ModeSlots

_ROOM, _TIMES = Const(2.0), Const(3.0)


def assignment(mode: Mode, row: int, value: Value) -> Action:
    """Return the statement that puts a mode's number, or numbers, into a row of `ModeSlots`."""
    slot = row + mode.first
    return Set(slot, value, mode.where) if mode.is_scalar else SetVec(slot, mode.count, value, mode.where)


def stage_pass(live: Sequence[Action], modes: Iterable[Mode], slots: ModeSlots) -> tuple[Action, ...]:
    """Return the pass at the second stage's t and states: `live` is that which computes the modes."""

    def argument(mode: Mode, action: Action) -> list[Action]:
        return [action] if is_bounded(mode) else [_moved(action, slots.stage - slots.arguments)]

    def found(mode: Mode, action: Action) -> list[Action]:
        if is_bounded(mode):
            return [action, assignment(mode, slots.first, mode.at(slots.live))]
        return [assignment(mode, slots.live, Op(mode.operation, (mode.at(slots.stage),)))]

    unsure: list[Action] = []  # where an `if` leaves a mode out, nothing has switched
    for mode in conditional(live, modes, slots):
        unsure += [assignment(mode, row, mode.at(slots.frozen)) for row in (slots.first, slots.second)]
    return (*unsure, *_rewrite(live, _Places(modes, slots, argument, found)))


def end_pass(live: Sequence[Action], modes: Iterable[Mode], slots: ModeSlots) -> tuple[Action, ...]:
    """Return the pass at the step's end."""

    def argument(mode: Mode, action: Action) -> list[Action]:
        return [action] if is_bounded(mode) else [_moved(action, slots.second - slots.arguments)]

    def found(mode: Mode, action: Action) -> list[Action]:
        if is_bounded(mode):
            return [action, assignment(mode, slots.second, mode.at(slots.live))]
        start, stage, end = (mode.at(row) for row in (slots.arguments, slots.stage, slots.second))
        if has_margin(mode):
            moved = Op("add", tuple(Op("abs", (Op("sub", (end, other)),)) for other in (start, stage)))
            margin = Op("sub", (Op("abs", (end,)), Op("mul", (_TIMES, moved))))
            near = Op("swtch", (Op("neg", (mode.at(slots.stage),)),))
            return [
                assignment(mode, slots.live, Op(mode.operation, (end,))),
                assignment(mode, slots.stage, margin),
                assignment(mode, slots.arguments, end),
                assignment(mode, slots.first, Op("add", (mode.at(slots.frozen), near))),
                assignment(mode, slots.second, mode.at(slots.live)),
            ]
        least = Op("min", (Op("min", (start, stage)), end))
        most = Op("max", (Op("max", (start, stage)), end))
        room = Op("mul", (_ROOM, Op("sub", (most, least))))
        low, high = mode.at(slots.first), mode.at(slots.stage)
        made = [
            assignment(mode, slots.live, Op(mode.operation, (end,))),
            assignment(mode, slots.first, Op("sub", (least, room))),
            assignment(mode, slots.stage, Op("add", (most, room))),
            assignment(mode, slots.arguments, end),
            assignment(mode, slots.second, Op(mode.operation, (high,))),
        ]
        if mode.operation != "rect":
            return [*made, assignment(mode, slots.first, Op(mode.operation, (low,)))]
        passed = Op("sub", (Op("deadc", (low,)), Op("deadc", (high,))))  # 0 on both sides of its 1
        value = Op("add", (mode.at(slots.frozen), Op("abs", (passed,))))
        return [*made, assignment(mode, slots.first, value)]

    return _rewrite(live, _Places(modes, slots, argument, found))


def is_bounded(mode: Mode) -> bool:
    """Whether a mode is the same between two places where it is, if its argument is so there."""
    return mode.is_affine and mode.operation != "rect"


def has_margin(mode: Mode) -> bool:
    """Whether `stage` is below 0 behind the step if a mode that is not bounded may have switched."""
    return not is_bounded(mode) and THRESHOLDS[mode.operation] is Threshold.ZERO


class _Places:
    """What stands instead of the statements that compute modes and their arguments, by their first slots."""

    def __init__(
        self,
        modes: Iterable[Mode],
        slots: ModeSlots,
        argument: Callable[[Mode, Action], list[Action]],
        found: Callable[[Mode, Action], list[Action]],
    ) -> None:
        self._modes = {mode.first: mode for mode in modes}
        self._slots = slots
        self._argument, self._found = argument, found

    def instead_of(self, action: Action) -> list[Action]:
        """Return what stands instead of a statement."""
        for slot, _ in writes(action):
            for row, make in ((self._slots.arguments, self._argument), (self._slots.live, self._found)):
                mode = self._modes.get(slot - row)
                if mode is not None:
                    return make(mode, action)
        return [action]


def _rewrite(actions: Iterable[Action], places: _Places) -> tuple[Action, ...]:
    made: list[Action] = []
    for action in actions:
        if isinstance(action, Guard):
            made.append(with_bodies(action, _rewrite(action.body, places), _rewrite(action.orelse, places)))
        else:
            made += places.instead_of(action)
    return tuple(made)


def _moved(action: Action, by: int) -> Action:
    """Return an assignment to another row."""
    match action:
        case Set():
            return Set(action.slot + by, action.value, action.where)
        case SetMat():
            return SetMat(action.slot + by, action.rows, action.cols, action.value, action.where)
        case SetVec():
            return SetVec(action.slot + by, action.count, action.value, action.where)
    raise AssertionError(action)


def conditional(live: Sequence[Action], modes: Iterable[Mode], slots: ModeSlots) -> list[Mode]:
    """Return the modes that are not computed in every pass."""
    always = {slot for action in live if not isinstance(action, Guard) for slot, _ in writes(action)}
    return [mode for mode in modes if slots.live + mode.first not in always]
