"""Scalar statements that are a vector statement in disguise become a loop again.

A ladder network, a chain of reactions or a grid written out as scalar equations has hundreds of neighbours
of one shape, whose operands stand side by side in memory or come round every few statements. As one loop they
cost nothing to compile and run as fast as vector code. Only exact operations are rolled up: library functions
have other last bits in vectors than alone, and results must not depend on a neighbour's edit.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.cancellation import cancellation_point
from desire_tui.engine.codegen.ir.functions import C_FUNCTIONS
from desire_tui.engine.codegen.scalar.templates import NotPlainError, shape
from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.lowered.statements import Deriv, Set
from desire_tui.engine.recently_used import RecentlyUsed

if TYPE_CHECKING:
    from collections.abc import Iterable

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.statements import Action

_RUN_LEAST = 16
"""Shorter runs are not worth a loop."""
_INEXACT = frozenset((*C_FUNCTIONS, "sinc", "sigmoid"))

_Shape = tuple[tuple[object, ...], list[int | float]]
_SHAPES_ROOM = 5_000
"""Shapes of earlier programs' values: some 1 KB each."""
_shapes: RecentlyUsed[int, tuple[Value, _Shape | None]] = RecentlyUsed(_SHAPES_ROOM)
"""By the value's id, which stays taken: lowering gives the same value for the same text again."""


@dataclass(frozen=True, slots=True, eq=False)
class Rolled:
    """`count` statements like `first`, whose targets follow one another.

    `operands[q]` says where the leaf number q of each comes from: a slot (int) if they stand side by side
    from there on; a tuple of slots (int) and numbers (float) that come round.
    """

    first: Set | Deriv
    count: int
    operands: tuple[int | tuple[int | float, ...], ...]


class _Run:
    """A run as it grows."""

    __slots__ = ("actions", "contiguous", "key", "kind", "leaves", "periodic", "target")

    def __init__(self, action: Set | Deriv, key: tuple[object, ...], leaves: list[int | float]) -> None:
        self.actions = [action]
        self.kind = type(action)
        self.key = key
        self.leaves = [leaves]
        self.target = _target(action)
        self.contiguous = [type(leaf) is int for leaf in leaves]
        self.periodic = [True] * len(leaves)

    def extend(self, action: Set | Deriv, leaves: list[int | float], width: int) -> bool:
        """Add a statement of the same shape if it continues the run."""
        count = len(self.actions)
        if _target(action) != self.target + count:
            return False
        first = self.leaves[0]
        earlier = self.leaves[count - width] if count >= width else None
        contiguous, periodic = self.contiguous, self.periodic
        changed = []
        for q, leaf in enumerate(leaves):
            is_contiguous = contiguous[q] and leaf == first[q] + count and type(leaf) is int
            is_periodic = periodic[q] and (earlier is None or leaf is earlier[q] or _same(leaf, earlier[q]))
            if not (is_contiguous or is_periodic):
                return False
            if is_contiguous is not contiguous[q] or is_periodic is not periodic[q]:
                changed.append((q, is_contiguous, is_periodic))
        for q, is_contiguous, is_periodic in changed:
            contiguous[q], periodic[q] = is_contiguous, is_periodic
        self.actions.append(action)
        self.leaves.append(leaves)
        return True

    def result(self, width: int) -> list[Action | Rolled]:
        """Return the run as one, or its statements if it is short or a statement reads what another sets."""
        count = len(self.actions)
        if count < _RUN_LEAST:
            return list(self.actions)
        operands: list[int | tuple[int | float, ...]] = []
        for q, leaf in enumerate(self.leaves[0]):
            if self.contiguous[q]:
                assert isinstance(leaf, int)
                operands.append(leaf)
            else:
                operands.append(tuple(leaves[q] for leaves in self.leaves[:width]))
        action = self.actions[0]
        if isinstance(action, Set) and _reads_its_targets(operands, action.slot, count):
            return list(self.actions)
        return [Rolled(action, count, tuple(operands))]


def _same(a: float, b: float) -> bool:
    return a == b and type(a) is type(b) and (a != 0 or str(a) == str(b))


def _target(action: Set | Deriv) -> int:
    return action.slot if isinstance(action, Set) else action.state


def _reads_its_targets(operands: Iterable[int | tuple[int | float, ...]], first: int, count: int) -> bool:
    for operand in operands:
        if isinstance(operand, int):
            if operand != first and operand < first + count and first < operand + count:
                return True
        elif any(isinstance(slot, int) and first <= slot < first + count for slot in operand):
            return True
    return False


def roll(actions: Iterable[Action], width: int) -> list[Action | Rolled]:
    """Return the statements with long runs of one shape rolled up; order and meaning stay."""
    done: list[Action | Rolled] = []
    run: _Run | None = None
    for action in actions:
        cancellation_point()
        found = _plain(action)
        if found is None:
            if run is not None:
                done += run.result(width)
                run = None
            done.append(action)
            continue
        key, leaves = found
        assert type(action) is Set or type(action) is Deriv
        if run is not None:
            if run.kind is type(action) and run.key == key and run.extend(action, leaves, width):
                continue
            done += run.result(width)
        run = _Run(action, key, leaves)
    if run is not None:
        done += run.result(width)
    return done


def age() -> None:
    """Between two programs: forget shapes of values that no program of late had."""
    _shapes.age()


def _plain(action: Action) -> _Shape | None:
    """Return shape and leaves of the value of a statement that may be rolled up."""
    if type(action) is not Deriv and type(action) is not Set:
        return None
    value = action.value
    known = _shapes[id(value)]
    if known is None:
        known = value, _shape(value)
        _shapes.keep(id(value), known)
    return known[1]


def _shape(value: Value) -> _Shape | None:
    key: list[object] = []
    leaves: list[int | float] = []
    try:
        shape(value, key, leaves)
    except NotPlainError:
        return None
    if not _INEXACT.isdisjoint(key):
        return None
    return tuple(key), leaves
