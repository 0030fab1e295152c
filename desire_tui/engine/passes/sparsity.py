"""Which derivatives depend on which states: the pattern of the Jacobian, found from the statements.

What a vector depends on is kept as a few *dependencies*, not element by element: a `diagonal` one says that
element i depends on state `first` + i, a `block` that every element depends on the states `first` …
`last` − 1; both for lo ≤ i < hi. Elementwise operations keep dependencies, shifts move them, products with
matrices make blocks. So a heat equation over a million states has three of them. The pattern may be larger
than the truth, never smaller.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, assert_never

import numpy as np

from desire_tui.engine.lowered.effects import memory, reads, reads_replaced, writes
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
from desire_tui.engine.lowered.statements import Deriv, DerivVec, Guard, Set, SetVec
from desire_tui.engine.passes.slices import derivative_slice

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.statements import Action

    Entries = tuple[NDArray[np.int32], NDArray[np.int32]]


class Dependency(NamedTuple):
    """Elements lo … hi − 1 depend on states: see above."""

    kind: str
    first: int
    last: int
    lo: int
    hi: int


Dependencies = frozenset[Dependency]
_NONE: Dependencies = frozenset()


def sparsity_pattern(segment: Segment) -> Entries:
    """Return rows and columns of the entries of ∂(dx/dt)/∂x that may differ from 0, some twice."""
    finder = _Finder(segment)
    finder.run(derivative_slice(segment), certain=True)
    return finder.entries()


class _Finder:
    def __init__(self, segment: Segment) -> None:
        self._scalars: dict[int, Dependencies] = {}
        self._arrays: dict[tuple[int, int], Dependencies] = {}
        self._derivatives: set[tuple[int, int, Dependency]] = set()
        for s in segment.states:
            if s.count == 1:
                self._scalars[s.slot] = frozenset({Dependency("block", s.first, s.first + 1, 0, 1)})
            else:
                self._arrays[s.slot, s.count] = frozenset({Dependency("diagonal", s.first, 0, 0, s.count)})

    def run(self, actions: Iterable[Action], *, certain: bool) -> None:
        """Follow the statements; under an `if` (not `certain`) an assignment may leave the old value."""
        for action in actions:
            if isinstance(action, Guard):
                self.run(action.body, certain=False)
                self.run(action.orelse, certain=False)
            elif isinstance(action, Deriv):
                self._derivatives |= {(action.state, 1, dependency) for dependency in self.of(action.value)}
            elif isinstance(action, DerivVec):
                dependencies = _spread(self.of(action.value), action.count)
                self._derivatives |= {(action.state, action.count, dependency) for dependency in dependencies}
            else:
                self._assign(action, certain=certain)

    def _assign(self, action: Action, *, certain: bool) -> None:
        if isinstance(action, Set | SetVec) and not reads_replaced(action):
            dependencies = self.of(action.value)
            adds = isinstance(action, SetVec) and action.mode == "add"
            certain = certain and not action.persistent and not adds
        else:  # sums, matrices, recursion and whatever else: everything depends on everything that is read
            dependencies = _block(self._read(slot, count) for slot, count in reads(action))
        for slot, count in writes(action):
            dependencies = _spread(dependencies, count)
            if count == 1:
                self._scalars[slot] = (
                    dependencies if certain else dependencies | self._scalars.get(slot, _NONE)
                )
            elif dependencies or (slot, count) in self._arrays:
                self._arrays[slot, count] = (
                    dependencies if certain else dependencies | self._arrays.get((slot, count), _NONE)
                )

    # ------------------------------------------------------------------ expressions

    def of(self, value: Value) -> Dependencies:
        """Return what an expression depends on."""
        match value:
            case Const():
                return _NONE
            case Op():
                count = extent(value)
                return frozenset(b for argument in value.args for b in _spread(self.of(argument), count))
            case Load():
                return self._read(value.slot, 1)
            case Vec():
                return self._read(value.slot, value.count)
            case ShiftedVec():
                return _shift(self._read(value.slot, value.count), value.by, value.count)
            case Table1():
                return self.of(value.x)
            case Table2():
                count = extent(value)
                return _spread(self.of(value.x), count) | _spread(self.of(value.y), count)
            case MatVec() | PatternRow() | Outer():
                read = _block(self._read(slot, count) for slot, count in memory(value))
                return _spread(read, extent(value))
            case _:
                assert_never(value)

    def _read(self, slot: int, count: int) -> Dependencies:
        """Dependencies of the numbers in `slot` …, whatever names they were written under."""
        found: set[Dependency] = set()
        for (start, size), dependencies in self._arrays.items():
            if start < slot + count and slot < start + size:
                found.update(_window(dependencies, slot - start, count))
        if count == 1:
            found |= self._scalars.get(slot, _NONE)
        else:
            inside = range(slot, slot + count)
            few = inside if count < len(self._scalars) else [s for s in self._scalars if s in inside]
            for s in few:
                for dependency in self._scalars.get(s, _NONE):
                    found.add(dependency._replace(lo=s - slot, hi=s - slot + 1))
        return frozenset(_as_block(b) for b in found) if count == 1 else frozenset(found)

    # ------------------------------------------------------------------ the result

    def entries(self) -> Entries:
        """Write the dependencies out."""
        rows: list[NDArray[np.int64]] = [np.zeros(0, np.int64)]
        columns: list[NDArray[np.int64]] = [np.zeros(0, np.int64)]
        for state, count, dependency in self._derivatives:
            elements = np.arange(dependency.lo, min(dependency.hi, count))
            if dependency.kind == "diagonal":
                rows.append(state + elements)
                columns.append(dependency.first + elements)
            else:
                width = dependency.last - dependency.first
                rows.append(np.repeat(state + elements, width))
                columns.append(np.tile(np.arange(dependency.first, dependency.last), len(elements)))
        return np.concatenate(rows).astype(np.int32), np.concatenate(columns).astype(np.int32)


def extent(value: Value) -> int:
    """Return the number of elements of an expression."""
    match value:
        case Const() | Load():
            return 1
        case Op():
            return max((extent(argument) for argument in value.args), default=1)
        case Vec() | ShiftedVec():
            return value.count
        case Table1():
            return extent(value.x)
        case Table2():
            return max(extent(value.x), extent(value.y))
        case MatVec():
            return value.cols if value.transposed else value.rows
        case PatternRow():
            return value.cols
        case Outer():
            return value.u_count * value.v_count
        case _:
            assert_never(value)


def _spread(dependencies: Dependencies, count: int) -> Dependencies:
    """Spread a scalar's dependencies over the elements of a vector: it goes into each of them."""
    if count == 1:
        return dependencies
    return frozenset(
        b._replace(hi=count) if b.kind == "block" and (b.lo, b.hi) == (0, 1) else b for b in dependencies
    )


def _shift(dependencies: Dependencies, by: int, count: int) -> Dependencies:
    """Element i of the result is element i + by, 0 outside."""
    moved = set()
    for b in dependencies:
        first = b.first + by if b.kind == "diagonal" else b.first
        lo, hi = max(b.lo - by, 0), min(b.hi - by, count)
        if lo < hi:
            moved.add(b._replace(first=first, lo=lo, hi=hi))
    return frozenset(moved)


def _window(dependencies: Dependencies, start: int, count: int) -> Dependencies:
    """Dependencies of the elements from `start` on."""
    return _shift(dependencies, start, count)


def _as_block(dependency: Dependency) -> Dependency:
    """One element's dependency as a scalar's."""
    if dependency.kind == "block":
        return dependency._replace(lo=0, hi=1)
    return Dependency("block", dependency.first + dependency.lo, dependency.first + dependency.hi, 0, 1)


def _block(many: Iterable[Dependencies]) -> Dependencies:
    """Everything that any element depends on, as a scalar's dependencies."""
    return frozenset(_as_block(dependency) for dependencies in many for dependency in dependencies)
