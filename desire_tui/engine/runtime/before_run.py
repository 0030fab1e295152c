"""The value of an expression before a run's first pass: times that are fixed while it lasts."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, assert_never

from desire_tui.engine.library import LIBRARY, func1
from desire_tui.engine.lowered.expressions import (
    Const,
    Load,
    MatVec,
    Op,
    Outer,
    PatternRow,
    ShiftedVec,
    Table1,
    Table2,
    Vec,
)
from desire_tui.engine.lowered.walk import walk_values

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.statements import Set
    from desire_tui.engine.values import Values

_OPERATIONS: dict[str, Callable[..., float]] = {
    "add": lambda a, b: a + b,
    "sub": lambda a, b: a - b,
    "mul": lambda a, b: a * b,
    "div": lambda a, b: a / b if b else math.nan,
    "neg": lambda a: -a,
    "pow": math.pow,
    "ipow": math.pow,
}
"""What is no library function."""


def needed(wanted: Value, before: Sequence[Set]) -> tuple[Set, ...]:
    """Return those statements that an expression depends on, in their order."""
    slots = {node.slot for node in walk_values(wanted) if isinstance(node, Load)}
    found: list[Set] = []
    for action in reversed(before) if slots else ():
        if action.slot in slots:
            found.append(action)
            slots.discard(action.slot)
            slots.update(node.slot for node in walk_values(action.value) if isinstance(node, Load))
    return tuple(reversed(found))


def evaluate(wanted: Value, before: Sequence[Set], values: Values) -> float:
    """Return the value that the run's first pass finds behind some assignments; nan if there is none."""
    own: dict[int, float] = {}
    for action in before:
        own[action.slot] = _evaluate(action.value, values, own)
    return _evaluate(wanted, values, own)


def _evaluate(value: Value, values: Values, own: dict[int, float]) -> float:
    match value:
        case Const():
            return value.value
        case Load():
            return own.get(value.slot, values.cells[value.slot])
        case Table1():
            table = values.cells[value.slot : value.slot + 2 * value.count]
            return func1(_evaluate(value.x, values, own), table)
        case Op():
            entry = LIBRARY.get(value.name)
            function = _OPERATIONS.get(value.name) or (None if entry is None else entry.value)
            if function is None:  # ran(), gauss(), delay(): a time that is drawn is no time
                return math.nan
            numbers = (_evaluate(a, values, own) for a in value.args)
            try:
                return float(function(*numbers))  # type: ignore[arg-type]
            except (ArithmeticError, ValueError):
                return math.nan
        case Table2() | Vec() | ShiftedVec() | MatVec() | PatternRow() | Outer():
            return math.nan
        case _:
            assert_never(value)
