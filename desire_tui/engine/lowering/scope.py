"""What a segment may name: the script's quantities as they are, or as they could be.

`LiveScope` and `StaticScope` both hand out `Quantity` objects. A static scope does not know every size: a
dimension it does not know is `UNKNOWN`, which agrees with any other.
"""

from __future__ import annotations

from math import prod
from typing import TYPE_CHECKING, Protocol

from desire_tui.engine.values import SYSTEM_SLOTS, SYSTEM_VARIABLES, Kind, Quantity, Values

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

UNKNOWN = -1


def agree(a: int, b: int) -> bool:
    """Whether two sizes can be the same."""
    return a == b or UNKNOWN in (a, b)


def size_of(quantity: Quantity) -> int:
    """Return the number of elements, or UNKNOWN."""
    return UNKNOWN if UNKNOWN in quantity.shape else prod(quantity.shape)


def _are_real_scalars(quantities: Iterable[Quantity | None]) -> bool:
    """Whether all that are there are scalars of kind REAL."""
    real = Kind.REAL  # looked up once: an enumeration's attributes take their time
    return not [q for q in quantities if q is not None and (q.shape or q.kind is not real)]


class SegmentScope(Protocol):
    """Names, their quantities, and the values known now."""

    @property
    def names(self) -> Mapping[str, Quantity]:
        """Every quantity by name."""
        ...

    @property
    def times_of_files(self) -> Mapping[str, str]:
        """The columns of times of data files, which have no tables, and the files' names."""
        ...

    def is_defined(self, quantity: Quantity) -> bool:
        """Whether a scalar has a value before the run."""
        ...

    def scalar(self, name: str, *, is_state: bool = False) -> Quantity:
        """Return the scalar of that name, made if new."""
        ...

    def states(self, names: Sequence[str]) -> list[int] | None:
        """Return the slots of the scalars of these names, made if new, as states; None: one cannot be one."""
        ...

    def hidden(self, count: int) -> int:
        """Return the first of `count` slots of the compiler's own, whose values last from run to run."""
        ...

    def constant(self, quantity: Quantity, offset: int = 0) -> float | None:
        """Return the present value of a number; None if it is not known yet."""
        ...


class LiveScope:
    """The session's quantities with their actual values, at `drun`."""

    def __init__(self, values: Values) -> None:
        self.values = values
        self.names: Mapping[str, Quantity] = values.names
        self.times_of_files: Mapping[str, str] = values.times_of_files
        self.constants: dict[int, float] = {}
        """Every number whose present value was asked for, by its slot."""

    def is_defined(self, quantity: Quantity) -> bool:
        """Whether the script (or an earlier run) gave it a value; states start at 0."""
        return quantity.is_state or self.values.is_readable(quantity)

    def scalar(self, name: str, *, is_state: bool = False) -> Quantity:
        """Return the scalar of that name, made if new."""
        made = self.values.scalar(name, is_state=is_state)
        if is_state and not made.is_state:
            made.is_state = True
        return made

    def states(self, names: Sequence[str]) -> list[int] | None:
        """Return the slots of the scalars of these names, made if new, as states; None: one cannot be one."""
        if not _are_real_scalars(map(self.names.get, names)):
            return None
        if not self.names.keys() >= {*names}:
            for name in names:
                self.values.scalar(name)
        quantities = [*map(self.names.__getitem__, names)]
        for quantity in quantities:
            quantity.is_state = True
        return [quantity.slot for quantity in quantities]

    def hidden(self, count: int) -> int:
        """Return the first of `count` slots of the compiler's own."""
        return self.values.unnamed(count)

    def constant(self, quantity: Quantity, offset: int = 0) -> float | None:
        """Return the present value."""
        slot = quantity.slot + offset
        value = self.constants[slot] = self.values.cells[slot]
        return value


class StaticScope:
    """Quantities as the text of the script shows them, for checks before a run. Slots are only identities."""

    def __init__(
        self,
        quantities: Iterable[Quantity],
        scalars: Iterable[str],
        constants: Mapping[str, float],
        first_free: int,
        times_of_files: Mapping[str, str],
    ) -> None:
        self.times_of_files = times_of_files
        self.names: dict[str, Quantity] = {q.name: q for q in quantities}
        self._constants = constants
        self._defined = set(scalars)
        self._next = first_free
        for slot, name in enumerate(SYSTEM_VARIABLES):
            self.names[name] = Quantity(name, slot)
        for name in self._defined:
            self.scalar(name)

    def is_defined(self, quantity: Quantity) -> bool:
        """Whether some statement could have given it a value."""
        return quantity.is_state or quantity.slot < SYSTEM_SLOTS or quantity.name in self._defined

    def scalar(self, name: str, *, is_state: bool = False) -> Quantity:
        """Return the scalar of that name, made if new."""
        known = self.names.get(name)
        if known is None:
            known = self.names[name] = Quantity(name, self.hidden(1))
        if is_state and not known.is_state:
            known = self.names[name] = Quantity(name, known.slot, known.shape, known.kind, is_state=True)
        return known

    def states(self, names: Sequence[str]) -> list[int] | None:
        """Return the slots of the scalars of these names, made if new, as states; None: one cannot be one."""
        if not _are_real_scalars(map(self.names.get, names)):
            return None
        return [self.scalar(name, is_state=True).slot for name in names]

    def hidden(self, count: int) -> int:
        """Return the first of `count` slots of the compiler's own."""
        slot = self._next
        self._next += max(count, 1)
        return slot

    def constant(self, quantity: Quantity, offset: int = 0) -> float | None:
        """Return a value that the script fixes; None if it may change."""
        return self._constants.get(quantity.name) if offset == 0 else None
