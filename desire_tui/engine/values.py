"""All quantities of a session in one flat array of doubles.

Interpreter, compiled code and panes share it: a parameter never needs recompiling, `x` in the script and in a
segment is the same number, overlays (`ARRAY a[n] + b[m] = ab`) are plain aliases. A large piece of address
space is reserved once and pages are touched only as they are used, so **addresses never change** while a
session lives and compiled code may keep them. Scalars stand in its first part, arrays behind: only scalars
need to know whether they are defined, so an array costs nothing but its own numbers.
"""

from __future__ import annotations

from enum import Enum
from math import prod
from operator import attrgetter
from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.address_space import AddressSpace
from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.diagnostics import DesireError, Diagnostic

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from numpy.typing import NDArray


SYSTEM_VARIABLES = (
    "t", "TMAX", "DT", "NN", "scale", "DTMAX", "DTMIN", "ERMAX", "ERMIN", "ERRMAX", "CHECKN", "MM", "iRow",
    "PI",
)  # fmt: skip
(
    T, TMAX, DT, NN, SCALE, DTMAX, DTMIN, ERMAX, ERMIN, ERRMAX, CHECKN, MM, IROW, PI,
) = range(len(SYSTEM_VARIABLES))  # fmt: skip
SYSTEM_SLOTS = len(SYSTEM_VARIABLES)

SCALAR_SLOTS = 1 << 22
"""Slots below this one hold scalars: 32 MiB of address space, touched as needed."""
_ALIGN = 8  # arrays start on a cache line


class Kind(Enum):
    """Data types. INTEGER values are kept as whole doubles, COMPLEX as two doubles side by side."""

    REAL = 1
    INTEGER = 2
    COMPLEX = 3


@dataclass(slots=True, eq=False)
class Quantity:
    """A named scalar (`shape` is empty) or array; its numbers stand from `slot` on, in row-major order."""

    name: str
    slot: int
    shape: tuple[int, ...] = ()
    kind: Kind = Kind.REAL
    is_state: bool = False
    of_file: bool = False
    """Whether it is a table that `data 'file'` made: it may do so again, with more rows or fewer."""

    @property
    def size(self) -> int:
        """Number of elements."""
        return prod(self.shape)

    @property
    def slots(self) -> int:
        """Number of doubles."""
        return self.size * (2 if self.kind is Kind.COMPLEX else 1)


_PLACE = attrgetter("name", "slot", "shape", "kind", "is_state", "of_file")
"""What a layout holds of a quantity: its fields in their order."""


@dataclass(frozen=True, slots=True)
class Saved:
    """All numbers as they were at some time, and the state of `ran()`."""

    numbers: tuple[tuple[int, NDArray[np.float64]], ...]
    defined: bytes
    random: NDArray[np.uint64]
    generation: int


@dataclass(frozen=True, slots=True)
class Layout:
    """Which names there are and where: two that are equal mean the same by the same slots."""

    quantities: tuple[tuple[str, int, tuple[int, ...], Kind, bool, bool], ...]
    scalars: int
    arrays: int
    defined: bytes


class Values:
    """The session's quantities by name, and their numbers.

    `cells[slot]` reads and writes one number quickly; `data` is the same memory as a NumPy array;
    `defined[slot]` is 0 for a scalar nobody has assigned yet (array elements are always defined, and their
    slots, from `SCALAR_SLOTS` on, have no place in it: ask `is_defined`);
    `random[0]` is the 48-bit state of `ran()`; `generation` counts how often all names were cleared.
    `elements_most` limits the arrays; by default the machine's memory does.
    """

    def __init__(self, elements_most: int | None = None) -> None:
        self._space = AddressSpace(None if elements_most is None else 8 * (SCALAR_SLOTS + elements_most))
        view = self._space.view
        self.capacity = len(view) // 8
        self.cells: memoryview[float] = view.cast("d")
        self.data: NDArray[np.float64] = np.frombuffer(view, dtype=np.float64)
        self.defined = bytearray(1024)
        self.random = np.zeros(1, dtype=np.uint64)
        self._address = int(self.data.ctypes.data)
        self.random_address = int(self.random.ctypes.data)
        self.seeding: Callable[[int], int] | None = None
        """In a study: what SEED makes of its state, so that each run draws numbers of its own."""
        self.names: dict[str, Quantity] = {}
        self.times_of_files: dict[str, str] = {}
        """The columns of times that `data 'file'` met, for messages, and the files' names."""
        self.generation = 0
        self.replacements = 0
        """How often an array gave way to one of another size: code that knows slots is made anew."""
        self._scalars = 0
        self._arrays = SCALAR_SLOTS
        self._begin()

    @property
    def address(self) -> int:
        """Address of slot 0."""
        return self._address

    @property
    def spare(self) -> int:
        """How many more numbers there is memory for; whole-array statements need some for a moment."""
        return self.capacity - self._arrays

    def clear(self) -> None:
        """Forget all names (`clear`, `erun`); system variables remain, undefined but for PI and scale."""
        self._space.zero(0, 8 * self._scalars)
        self._space.zero(8 * SCALAR_SLOTS, 8 * (self._arrays - SCALAR_SLOTS))
        self.generation += 1
        self._begin()

    def _begin(self) -> None:
        self.names.clear()
        self.times_of_files.clear()
        self._scalars = 0
        self._arrays = SCALAR_SLOTS
        self.defined[:] = bytes(len(self.defined))
        for name in SYSTEM_VARIABLES:
            self.scalar(name)
        self.assign(PI, float(np.pi))
        self.assign(SCALE, 1.0)

    def __iter__(self) -> Iterator[Quantity]:
        return iter(list(self.names.values()))

    def find(self, name: str) -> Quantity | None:
        """Return the quantity of that name, if there is one (a scalar may still be undefined)."""
        return self.names.get(name)

    def scalar(self, name: str, kind: Kind = Kind.REAL, *, is_state: bool = False) -> Quantity:
        """Return the quantity `name`, made as an undefined scalar if it is new."""
        known = self.names.get(name)
        if known is not None:
            return known
        slot = self.unnamed(2 if kind is Kind.COMPLEX else 1)
        made = self.names[name] = Quantity(name, slot, (), kind, is_state)
        return made

    def unnamed(self, slots: int) -> int:
        """Return the first of some new, undefined scalar slots (a PROCEDURE's dummy arguments)."""
        slot = self._scalars
        if slot + slots > SCALAR_SLOTS:
            raise DesireError(Diagnostic("out-of-memory", facts={"elements": slots}))
        self._scalars += slots
        if len(self.defined) < self._scalars:
            self.defined.extend(bytes(max(len(self.defined), self._scalars - len(self.defined))))
        return slot

    def array(
        self, name: str, shape: Sequence[int], kind: Kind = Kind.REAL, *, is_state: bool = False
    ) -> Quantity:
        """Make a zero-filled array. The caller has checked that the name is free. DesireError 40: no room."""
        made = Quantity(name, self._arrays, tuple(shape), kind, is_state)
        if made.slots > self.capacity - self._arrays:
            raise DesireError(Diagnostic("out-of-memory", facts={"elements": made.slots}))
        self._arrays = -(-(made.slot + made.slots) // _ALIGN) * _ALIGN
        self.names[name] = made
        return made

    def table(self, name: str, count: int) -> Quantity:
        """Make the vector that `data 'file'` fills, in place of an earlier one of another size."""
        known = self.names.get(name)
        if known is not None and known.of_file and known.shape == (count,):
            return known
        if known is not None:
            self.replacements += 1
        made = self.array(name, (count,))
        made.of_file = True
        return made

    def room(self, count: int) -> int:
        """Return the first of `count` new, nameless array slots, filled with 0 (for compiled code)."""
        slot = self.array("", (count,)).slot
        del self.names[""]
        return slot

    def zero(self, quantity: Quantity) -> None:
        """Fill with zeros (an array declared again)."""
        self._space.zero(8 * quantity.slot, 8 * quantity.slots)

    def alias(self, name: str, shape: Sequence[int], slot: int, *, is_state: bool = False) -> Quantity:
        """Give existing numbers a second name (overlays and views)."""
        made = self.names[name] = Quantity(name, slot, tuple(shape), Kind.REAL, is_state)
        return made

    def assign(self, slot: int, value: float) -> None:
        """Set a scalar (perhaps part of an array) and mark it defined."""
        self.cells[slot] = value
        if slot < SCALAR_SLOTS:
            self.defined[slot] = 1

    def is_defined(self, quantity: Quantity) -> bool:
        """Whether it has a value: arrays always, scalars once assigned."""
        slot = quantity.slot
        return slot >= SCALAR_SLOTS or bool(quantity.shape) or bool(self.defined[slot])

    def is_readable(self, quantity: Quantity) -> bool:
        """Whether an expression may read it: settings that nobody set read as 0."""
        return quantity.slot < SYSTEM_SLOTS or self.is_defined(quantity)

    @property
    def numbers_used(self) -> int:
        """How many numbers there are, all scalars and arrays together."""
        return self._scalars + self._arrays - SCALAR_SLOTS

    def saved(self) -> Saved:
        """Return a copy of all numbers, for `restore`."""
        scalars, arrays = self.data[: self._scalars], self.data[SCALAR_SLOTS : self._arrays]
        numbers = ((0, scalars.copy()), (SCALAR_SLOTS, arrays.copy()))
        return Saved(numbers, bytes(self.defined), self.random.copy(), self.generation)

    def copied(self) -> Values:
        """Return quantities of the same names, slots and numbers that share nothing with these."""
        saved = self.saved()
        copy = Values(self._arrays - SCALAR_SLOTS + _ALIGN)
        copy.names = dict(self.names)
        copy._scalars, copy._arrays, copy.generation = self._scalars, self._arrays, self.generation
        copy.defined = bytearray(saved.defined)
        copy.restore(saved)
        return copy

    def restore(self, saved: Saved) -> None:
        """Put numbers back; names made since stay, with the numbers they have."""
        for first, numbers in saved.numbers:
            self.data[first : first + len(numbers)] = numbers
        self.defined[: len(saved.defined)] = saved.defined
        self.random[:] = saved.random

    def layout(self) -> Layout:
        """Return all names with their places, in the order in which they were made."""
        return Layout(
            tuple(map(_PLACE, self.names.values())),
            self._scalars,
            self._arrays,
            bytes(self.defined[: self._scalars]),
        )

    def lay_out(self, layout: Layout) -> None:
        """Make the names that a layout has besides those there are, which must be the first of its own."""
        for made in layout.quantities:
            known = self.names.get(made[0])
            if known is None:
                self.names[made[0]] = Quantity(*made)
            else:
                known.is_state = made[4]
        self._scalars, self._arrays = layout.scalars, layout.arrays
        if len(self.defined) < self._scalars:
            self.defined.extend(bytes(self._scalars - len(self.defined)))
        self.defined[: self._scalars] = layout.defined

    def view(self, quantity: Quantity) -> NDArray[np.float64] | NDArray[np.complex128]:
        """Return an array's numbers in its shape, sharing memory."""
        flat = self.data[quantity.slot : quantity.slot + quantity.slots]
        if quantity.kind is Kind.COMPLEX:
            return flat.view(np.complex128).reshape(quantity.shape)
        return flat.reshape(quantity.shape)
