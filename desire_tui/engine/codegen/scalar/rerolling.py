"""Scalar statements that are a vector statement in disguise become a loop again.

A ladder network, a chain of reactions or a grid written out as scalar equations has hundreds of neighbours
of one shape, whose operands stand side by side in memory or come round every few statements. As one loop they
cost nothing to compile and run as fast as vector code. Only exact operations are rolled up: library functions
have other last bits in vectors than alone, and results must not depend on a neighbour's edit.
"""

from __future__ import annotations

from itertools import compress, count
from operator import attrgetter, ne
from typing import TYPE_CHECKING

from desire_tui.engine.cancellation import cancellation_point
from desire_tui.engine.codegen.ir.functions import C_FUNCTIONS
from desire_tui.engine.codegen.scalar.templates import NotPlainError, shape
from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.lowered.expressions import Op
from desire_tui.engine.lowered.statements import Deriv, Set
from desire_tui.engine.recently_used import RecentlyUsed

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.statements import Action

    _Shape = tuple[tuple[object, ...], Sequence[int | float]]

_RUN_LEAST = 16
"""Shorter runs are not worth a loop."""
_ONE_BY_ONE = 16
"""Statements at the start of a run before whole columns of operands are compared; no less than a vector's."""
_INEXACT = frozenset((*C_FUNCTIONS, "sinc", "sigmoid"))

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

    def __init__(self, action: Set | Deriv, key: tuple[object, ...], leaves: Sequence[int | float]) -> None:
        self.actions = [action]
        self.kind = type(action)
        self.key = key
        self.leaves = [leaves]
        self.target = _target(action)
        self.contiguous = [type(leaf) is int for leaf in leaves]
        self.periodic = [True] * len(leaves)

    def extend(self, action: Action, found: _Shape | None, width: int) -> bool:
        """Add a statement if it has the same shape and continues the run."""
        if found is None or found[0] != self.key or type(action) is not self.kind:
            return False
        size, leaves = len(self.actions), found[1]
        if _target(action) != self.target + size:
            return False
        first = self.leaves[0]
        earlier = self.leaves[size - width] if size >= width else None
        contiguous, periodic = self.contiguous, self.periodic
        changed = []
        for q, leaf in enumerate(leaves):
            is_contiguous = contiguous[q] and leaf == first[q] + size and type(leaf) is int
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

    def extend_many(self, actions: Sequence[Action], shapes: Sequence[_Shape | None], width: int) -> int:
        """Add the first of some statements that continue the run, `width` long at least; return how many.

        The same as `extend` for one after the other, by comparing whole columns of operands.
        """
        size = len(self.actions)
        keys, kinds = [found and found[0] for found in shapes], [*map(type, actions)]
        most = min(_alike(keys, [self.key] * len(keys)), _alike(kinds, [self.kind] * len(kinds)))
        added: list[Set | Deriv] = actions[:most]  # type: ignore[assignment]  # as their kind says
        targets = map(attrgetter("slot" if self.kind is Set else "state"), added)
        most = _alike([*targets], range(self.target + size, self.target + size + most))
        if not most:
            return 0
        leaves = [found[1] for found in shapes[:most] if found is not None]
        earlier = [*self.leaves[-width:], *leaves]
        lengths: list[tuple[int, int]] = []
        for q, (ours, before) in enumerate(
            zip(zip(*leaves, strict=True), zip(*earlier, strict=True), strict=True)
        ):
            side = _slots_from(ours, self.leaves[0][q] + size) if self.contiguous[q] else 0
            turn = _same_from_start(ours, before) if self.periodic[q] else 0
            lengths.append((side, turn))
            most = min(most, max(side, turn))
        for q, (side, turn) in enumerate(lengths):
            self.contiguous[q] = self.contiguous[q] and side >= most
            self.periodic[q] = self.periodic[q] and turn >= most
        self.actions += added[:most]
        self.leaves += leaves[:most]
        return most

    def result(self, width: int) -> list[Action | Rolled]:
        """Return the run as one, or its statements if it is short or a statement reads what another sets."""
        size = len(self.actions)
        if size < _RUN_LEAST:
            return list(self.actions)
        operands: list[int | tuple[int | float, ...]] = []
        for q, leaf in enumerate(self.leaves[0]):
            if self.contiguous[q]:
                assert isinstance(leaf, int)
                operands.append(leaf)
            else:
                operands.append(tuple(leaves[q] for leaves in self.leaves[:width]))
        action = self.actions[0]
        if isinstance(action, Set) and _reads_its_targets(operands, action.slot, size):
            return list(self.actions)
        return [Rolled(action, size, tuple(operands))]


def _alike(ours: Sequence[object], theirs: Sequence[object]) -> int:
    """Return how many values are equal to the others before the first that is not."""
    if [*ours] == [*theirs]:  # a third of the time, and what is mostly so
        return len(ours)
    return next(compress(count(), map(ne, ours, theirs)), len(ours))


def _slots_from(column: Sequence[float], first: float) -> int:
    """Return how many operands are slots that follow one another from `first` on."""
    if type(first) is not int:
        return 0
    most = _alike(column, range(first, first + len(column)))
    kinds = [*map(type, column[:most])]
    return kinds.index(float) if float in kinds else most


def _same_from_start(ours: Sequence[float], theirs: Sequence[float]) -> int:
    """Return how many operands are the same as the others, signs of zeros and kinds included."""
    most = _alike(ours, theirs)
    kinds = {*map(type, ours[:most]), *map(type, theirs[:most])}
    if kinds == {int} or (kinds == {float} and 0.0 not in ours[:most]):
        return most
    different = (at for at in range(most) if not (ours[at] is theirs[at] or _same(ours[at], theirs[at])))
    return next(different, most)


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


def roll(actions: Sequence[Action], width: int) -> list[Action | Rolled]:
    """Return the statements with long runs of one shape rolled up; order and meaning stay."""
    done: list[Action | Rolled] = []
    shapes = [*map(plain_shape, actions)]
    at, end = 0, len(actions)
    while at < end:
        cancellation_point()
        found = shapes[at]
        if found is None:
            done.append(actions[at])
            at += 1
            continue
        run = _Run(actions[at], *found)  # type: ignore[arg-type]  # what has a shape is Set or Deriv
        at += 1
        while at < end:
            size = len(run.actions)
            if size < _ONE_BY_ONE:
                wanted, taken = 1, int(run.extend(actions[at], shapes[at], width))
            else:
                wanted = 2 * size  # growing, so that all that is looked at stays a multiple of what is taken
                taken = run.extend_many(actions[at : at + wanted], shapes[at : at + wanted], width)
            at += taken
            if taken < wanted:
                break
        done += run.result(width)
    return done


def age() -> None:
    """Between two programs: forget shapes of values that no program of late had."""
    _shapes.age()


def plain_shape(action: Action) -> _Shape | None:
    """Return shape and leaves of the value of a statement that may be rolled up."""
    if type(action) is not Deriv and type(action) is not Set:
        return None
    value = action.value
    if type(value) is Op and value.outline is not None:
        return value.outline.key, value.leaves
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
