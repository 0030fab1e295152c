"""The switches of a segment under rules that control their steps, as back ends get them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from desire_tui.engine.lowered.expressions import Const, Load, Op, Table1

if TYPE_CHECKING:
    from collections.abc import Mapping

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.statements import Action, Where


JUMPS = frozenset(("swtch", "sgn", "comp", "deadc", "rect", "round", "trnc"))
KINKS = frozenset(("abs", "lim", "sat", "SAT", "deadz", "tri", "max", "min"))
"""Operations whose values, whose slopes jump."""
_BOUNDED = JUMPS | KINKS | frozenset((
    "add", "sub", "mul", "div", "neg", "recip", "ipow", "sin", "cos", "exp", "ln", "sqrt", "atan", "tanh",
))  # fmt: skip


def has_bounds(value: Value) -> bool:
    """Whether bounds of a node can be told from bounds of its operands (`integration.switching.bounds`)."""
    return value.name in _BOUNDED if isinstance(value, Op) else isinstance(value, Const | Load | Table1)


@dataclass(frozen=True)
class Mode:
    """Numbers that are constant while a step lasts: `count` of them, computed at one statement.

    `rising`: only a change from 0 to 1 counts (`term`, `event`).
    """

    first: int
    count: int
    name: str
    where: Where
    rising: bool = False


@dataclass(frozen=True)
class Switching:
    """What may switch in a segment.

    `modes` stand in a row from the slots `frozen` (in force) and `live` (at the present t and states) on;
    `live_pass` computes the latter. `clocks` are the expressions of t that switch, each with its place,
    `definitions` what the scalars in them mean.
    """

    modes: tuple[Mode, ...]
    frozen: int
    live: int
    live_pass: tuple[Action, ...]
    clocks: tuple[tuple[Value, Where], ...]
    definitions: Mapping[int, Value]

    @property
    def count(self) -> int:
        """Number of modes."""
        return sum(mode.count for mode in self.modes)
