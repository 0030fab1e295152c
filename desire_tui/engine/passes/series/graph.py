"""Makes series and constants, each once, and the pass that computes their values at a step's start."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.lowered.expressions import Const, Load, Op, Vec
from desire_tui.engine.lowered.statements import DotTerm, Set, SetDot, SetVec
from desire_tui.engine.passes.series.nodes import Constant, Series
from desire_tui.engine.passes.slot_set import SlotSet

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Iterable

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.statements import Action, Where
    from desire_tui.engine.passes.series.nodes import Kind, Operand

_NO_SLOT = -1


class NoSeriesError(Exception):
    """A statement has no Taylor series: `where` it is, `what` in it has none (a key of wording)."""

    def __init__(self, where: Where, what: str) -> None:
        super().__init__(what)
        self.where = where
        self.what = what


class Graph:
    """All nodes so far. `where` is the statement that is being translated."""

    def __init__(self, allocate: Callable[[int], int], where: Where) -> None:
        self._allocate = allocate
        self._known: dict[Hashable, Operand] = {}
        self._pairs: dict[tuple[str, int], tuple[Series, Series]] = {}
        self._stored: dict[int, Constant] = {}
        self._kept: list[Operand] = []
        """Ids stand in the keys: nothing may go."""
        self.nodes: list[Series] = []
        self.values_pass: list[Action] = []
        self.where = where
        self.remembered = SlotSet()
        """What some pass may read before it sets it: whoever reads it so has no series."""

    def keep_used(self, roots: Iterable[Operand]) -> None:
        """Leave out the nodes that these do not need."""
        used: set[int] = set()
        open_ = list(roots)
        while open_:
            operand = open_.pop()
            if isinstance(operand, Series) and id(operand) not in used:
                used.add(id(operand))
                open_ += operand.operands
        self.nodes = [node for node in self.nodes if id(node) in used]
        for number, node in enumerate(self.nodes):
            node.number = number

    # ------------------------------------------------------------------ constants

    def outside(self, slot: int, count: int | None) -> Constant:
        """Return what the pass has not set. NoSeriesError: it is what the pass before left there."""
        if self.remembered.overlaps(slot, count or 1):
            raise NoSeriesError(self.where, "remembers")
        if count is None:
            return self.constant(("load", slot), Load(slot), None)
        return self.constant(("array", slot, count), Vec(slot, count), count)

    def number(self, value: float) -> Constant:
        """Return a number."""
        return self.constant(("number", value.hex()), Const(value), None)

    def constant(self, key: Hashable, value: Value, count: int | None) -> Constant:
        """Return what `value` is at a step's start; `key` says what it is made of."""
        known = self._known.get(key)
        if known is None:
            known = self._keep(key, Constant(value, _NO_SLOT, count))
        assert isinstance(known, Constant)
        return known

    def held(self, operand: Operand) -> Constant:
        """Return an operand's value at a step's start."""
        if isinstance(operand, Constant):
            return operand
        return self.constant(("held", id(operand)), self.value(operand), operand.count)

    def computed(self, name: str, *operands: Constant) -> Constant:
        """Return an operation on constants."""
        key = ("computed", name, *map(id, operands))
        value = Op(name, tuple(operand.value for operand in operands))
        return self.constant(key, value, widest(*operands))

    def stored(self, constant: Constant) -> Constant:
        """Return a constant that stands in a slot, or is a number that the program's text tells."""
        told = constant.count is None and isinstance(constant.value, Const)
        if constant.slot != _NO_SLOT or told:
            return constant
        known = self._stored.get(id(constant))
        if known is None:
            value = constant.value
            if isinstance(value, Load | Vec):
                slot = value.slot
            else:
                slot = self._allocate(constant.count or 1)
                self._assign(slot, constant.count, value)
            place = Load(slot) if constant.count is None else Vec(slot, constant.count)
            known = self._stored[id(constant)] = Constant(place, slot, constant.count)
            self._kept += [constant, known]
        return known

    # ------------------------------------------------------------------ series

    def value(self, operand: Operand) -> Value:
        """Return the expression that reads an operand's value at a step's start."""
        if isinstance(operand, Constant):
            return operand.value
        return Load(operand.slot) if operand.count is None else Vec(operand.slot, operand.count)

    def given(self, kind: Kind, slot: int, count: int | None) -> Series:
        """Return a series whose values stand somewhere already."""
        made = Series(len(self.nodes), kind, slot, count, ())
        self.nodes.append(made)
        return made

    def series(
        self,
        kind: Kind,
        value: Value,
        *operands: Operand,
        count: int | None,
        by: int = 0,
        matrix: tuple[int, int, int, bool] | None = None,
    ) -> Series:
        """Return a series with a value of its own at a step's start."""
        placed = tuple(self.stored(o) if isinstance(o, Constant) else o for o in operands)
        name = value.name if isinstance(value, Op) else ""  # a + 1 and a - 1 are both raised
        key = (kind, name, *map(id, placed), by, matrix, count)
        known = self._known.get(key)
        if known is None:
            slot = self._allocate(count or 1)
            self._assign(slot, count, value)
            known = self._keep(key, Series(len(self.nodes), kind, slot, count, placed, by, matrix))
            assert isinstance(known, Series)
            self.nodes.append(known)
        assert isinstance(known, Series)
        return known

    def integral(self, value: Value, inner: Series) -> Series:
        """Return ∫ a · inner' with an a that is still to be told (`complete`)."""
        slot = self._allocate(inner.count or 1)
        self._assign(slot, inner.count, value)
        made = Series(len(self.nodes), "integral", slot, inner.count, ())
        self.nodes.append(made)
        return made

    def complete(self, integral: Series, factor: Operand, inner: Series) -> Series:
        """Tell an integral what it is: ∫ factor · inner'."""
        integral.operands = (self.stored(factor) if isinstance(factor, Constant) else factor, inner)
        return integral

    def pair(
        self, key: tuple[str, Series], make: Callable[[], tuple[Series, Series]]
    ) -> tuple[Series, Series]:
        """Return two series that are made together, once."""
        known = self._pairs.get((key[0], key[1].number))
        if known is None:
            known = self._pairs[key[0], key[1].number] = make()
        return known

    def select(self, condition: Constant, yes: Operand, no: Operand) -> Operand:
        """Return `yes` where the condition is above 0, else `no`."""
        if yes is no:
            return yes
        count = widest(condition, yes, no)
        if isinstance(yes, Constant) and isinstance(no, Constant):
            return self.computed("comp", condition, no, yes)
        condition = self.stored(condition)
        value = Op("comp", (condition.value, self.value(no), self.value(yes)))
        return self.series("select", value, condition, yes, no, count=count)

    def gather(self, lanes: tuple[tuple[Operand, int], ...]) -> Operand:
        """Return the array of elements of other operands."""
        key = ("gather", *((id(operand), at) for operand, at in lanes))
        known = self._known.get(key)
        if known is not None:
            return known
        slot, placed = self._allocate(len(lanes)), []
        for i, (operand, at) in enumerate(lanes):
            used = self.stored(operand) if isinstance(operand, Constant) else operand
            at_start = Load(used.slot + at) if used.count is not None else self.value(used)
            self.values_pass.append(Set(slot + i, at_start, self.where))
            placed.append((used, at))
        if all(isinstance(operand, Constant) for operand, _ in placed):
            return self._keep(key, Constant(Vec(slot, len(lanes)), slot, len(lanes)))
        operands = tuple({id(o): o for o, _ in placed}.values())
        made = Series(len(self.nodes), "gather", slot, len(lanes), operands, lanes=tuple(placed))
        self.nodes.append(made)
        return self._keep(key, made)

    def placed(self, constant: Constant) -> Constant:
        """Return a constant array as one that stands in slots of its own."""
        found = self.stored(constant)
        if isinstance(found.value, Vec):
            return found
        key = ("placed", id(found))
        slot = self._allocate(found.count or 1)
        self._assign(slot, found.count, found.value)
        return self._keep_constant(key, Constant(Vec(slot, found.count or 1), slot, found.count))

    def element(self, array: Operand, at: int = 0) -> Operand:
        """Return an array's element."""
        if isinstance(array, Constant):
            place = self.placed(array).slot + at
            return self.constant(("load", place), Load(place), None)
        return self.series("element", Load(array.slot + at), array, count=None, by=at)

    def total(self, product: Operand, slot: int, length: int) -> Operand:
        """Return the sum of an array's elements, at a step's start in `slot`."""
        array = self.placed(product) if isinstance(product, Constant) else product
        term = DotTerm(1.0, Vec(array.slot, length), None)
        self.values_pass.append(SetDot(slot, (term,), False, self.where))
        if isinstance(array, Constant):
            return Constant(Load(slot), slot, None)
        made = Series(len(self.nodes), "total", slot, None, (array,))
        self.nodes.append(made)
        return made

    def allocate(self, count: int | None) -> int:
        """Return the first of so many slots."""
        return self._allocate(count or 1)

    def _assign(self, slot: int, count: int | None, value: Value) -> None:
        if count is None:
            self.values_pass.append(Set(slot, value, self.where))
        else:
            self.values_pass.append(SetVec(slot, count, value, self.where))

    def _keep_constant(self, key: Hashable, made: Constant) -> Constant:
        known = self._keep(key, made)
        assert isinstance(known, Constant)
        return known

    def _keep(self, key: Hashable, made: Operand) -> Operand:
        self._known[key] = made
        self._kept.append(made)
        return made


def widest(*operands: Operand) -> int | None:
    """Return the number of elements of a result: None for a number."""
    return max((o.count for o in operands if o.count is not None), default=None)
