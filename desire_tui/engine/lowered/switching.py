"""The switches of a segment under rules that control their steps, as back ends get them."""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.lowered.expressions import Const, Load, Op, Table1, Vec

if TYPE_CHECKING:
    from collections.abc import Mapping

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.statements import Action, Where


JUMPS = frozenset(("swtch", "sgn", "comp", "deadc", "rect", "round", "trnc", "floor"))
KINKS = frozenset(("abs", "lim", "sat", "SAT", "deadz", "tri", "max", "min"))
"""Operations whose values, whose slopes jump."""
_BOUNDED = JUMPS | KINKS | frozenset((
    "add", "sub", "mul", "div", "neg", "recip", "ipow", "sin", "cos", "exp", "ln", "sqrt", "atan", "tanh",
))  # fmt: skip


def has_bounds(value: Value) -> bool:
    """Whether bounds of a node can be told from bounds of its operands (`integration.switching.bounds`)."""
    return value.name in _BOUNDED if isinstance(value, Op) else isinstance(value, Const | Load | Table1)


class Threshold(IntEnum):
    """Where a jump's argument makes it jump."""

    ZERO = 0
    UNIT = 1
    """At -1 and 1."""
    HALF = 2
    """Half-way between whole numbers."""
    WHOLE = 3
    """At whole numbers but 0."""
    EVERY_WHOLE = 4
    """At whole numbers."""


THRESHOLDS = {
    "swtch": Threshold.ZERO, "sgn": Threshold.ZERO, "deadc": Threshold.UNIT, "rect": Threshold.UNIT,
    "round": Threshold.HALF, "trnc": Threshold.WHOLE, "floor": Threshold.EVERY_WHOLE,
}  # fmt: skip
"""Of the operations that modes are computed by."""


@dataclass(frozen=True)
class ModeSlots:
    """First slots of rows with a number for each mode.

    `frozen`: in force while a step lasts. `live`: at the present t and states, of `arguments` there.
    The others tell whether a mode may have switched inside a step (`passes.watch_passes`): `first` and
    `second` are then other numbers than the frozen ones; `stage` holds arguments inside the step.
    """

    frozen: int
    live: int
    arguments: int
    stage: int
    first: int
    second: int

    ROWS = 6

    @classmethod
    def from_slot(cls, slot: int, room: int) -> ModeSlots:
        """Lay the rows out one behind the other."""
        return cls(*(slot + row * room for row in range(cls.ROWS)))


@dataclass(frozen=True)
class Mode:
    """Numbers that are constant while a step lasts: `count` of them, computed at one statement.

    `name` is what the program calls it, `operation` the jump that computes it. `is_affine`: its argument is a
    sum of t and states with constant factors while no mode switches. `rising`: only a change from 0 to 1
    counts (`term`, `event`). `is_scalar`: not an array, not of one element either.
    """

    first: int
    count: int
    name: str
    operation: str
    where: Where
    is_affine: bool
    is_scalar: bool
    rising: bool = False

    def at(self, row: int) -> Value:
        """Return what stands in a row of `ModeSlots`."""
        return Load(row + self.first) if self.is_scalar else Vec(row + self.first, self.count)


@dataclass(frozen=True)
class Switching:
    """What may switch in a segment.

    `live_pass` computes the modes at the present t and states; `stage_pass` and `end_pass`, of rules without
    an interpolant of their own, what tells at a step's end whether one may have switched in it. `clocks` are
    the expressions of t that switch, each with its place, `definitions` what the scalars in them mean.
    `bounded` are the jumps of all modes, of `moving` (slots of states, of t) and of what stays as it is in a
    run, if bounds can be told of every one of them; else both are empty.
    """

    modes: tuple[Mode, ...]
    slots: ModeSlots
    live_pass: tuple[Action, ...]
    stage_pass: tuple[Action, ...]
    end_pass: tuple[Action, ...]
    clocks: tuple[tuple[Value, Where], ...]
    definitions: Mapping[int, Value]
    bounded: tuple[Value, ...] = ()
    moving: tuple[int, ...] = ()

    @property
    def count(self) -> int:
        """Number of modes."""
        return sum(mode.count for mode in self.modes)
