"""Where scalars live while compiled code runs: in registers (small models) or in the values' memory."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from collections.abc import Iterable

    from desire_tui.engine.codegen.ir.text import IrText


class Cells(Protocol):
    """Scalars by slot, derivatives by state number."""

    def load(self, slot: int) -> str:
        """Read a scalar."""
        ...

    def store(self, slot: int, value: str) -> None:
        """Write a scalar."""

    def derivative(self, state: int, value: str) -> None:
        """Set the derivative of a state."""

    def forget(self, slot: int | None = None, count: int = 1) -> None:
        """Take these slots (None: all) as changed by other code."""


class MemoryCells:
    """Scalars in the values at `%v`, derivatives at `%dx`; what was read or written is not read again."""

    __slots__ = ("_known", "_text")

    def __init__(self, text: IrText) -> None:
        self._text = text
        self._known: dict[int, str] = {}

    def load(self, slot: int) -> str:
        """Read a scalar."""
        value = self._known.get(slot)
        if value is None:
            value = self._known[slot] = self._text.op(f"load double, ptr {self._at(slot)}")
        return value

    def store(self, slot: int, value: str) -> None:
        """Write a scalar."""
        self._text.do(f"store double {value}, ptr {self._at(slot)}")
        self._known[slot] = value

    def derivative(self, state: int, value: str) -> None:
        """Set the derivative of a state."""
        at = self._text.op(f"getelementptr double, ptr %dx, i64 {state}") if state else "%dx"
        self._text.do(f"store double {value}, ptr {at}")

    def forget(self, slot: int | None = None, count: int = 1) -> None:
        """Drop what is known of these slots."""
        if slot is None:
            self._known.clear()
        elif count < len(self._known):
            for s in range(slot, slot + count):
                self._known.pop(s, None)
        else:
            for s in [s for s in self._known if slot <= s < slot + count]:
                del self._known[s]

    def _at(self, slot: int) -> str:
        return self._text.op(f"getelementptr double, ptr %v, i64 {slot}") if slot else "%v"


class RegisterCells:
    """Scalars in stack cells that LLVM promotes to registers; `pinned` slots stay in the values' memory.

    `prefix` names the cells of the derivatives that the pass being written sets.
    """

    __slots__ = ("_memory", "pinned", "prefix", "slots", "text", "written")

    def __init__(self, text: IrText, slots: Iterable[int], pinned: frozenset[int]) -> None:
        self.text = text
        self.pinned = pinned
        self.slots = sorted(set(slots) - pinned)
        self.prefix = "%k1"
        self._memory = MemoryCells(text)
        self.written: set[int] = set()
        for slot in self.slots:
            text.alloca("double", f"%s{slot}")

    def load(self, slot: int) -> str:
        """Read a scalar."""
        if slot in self.pinned:
            self._memory.forget()
            return self._memory.load(slot)
        return self.text.op(f"load double, ptr %s{slot}")

    def store(self, slot: int, value: str) -> None:
        """Write a scalar."""
        if slot in self.pinned:
            self._memory.store(slot, value)
            return
        self.written.add(slot)
        self.text.do(f"store double {value}, ptr %s{slot}")

    def derivative(self, state: int, value: str) -> None:
        """Set the derivative of a state."""
        self.text.do(f"store double {value}, ptr {self.prefix}.{state}")

    def forget(self, slot: int | None = None, count: int = 1) -> None:
        """Nothing is kept in names."""

    def fetch(self) -> None:
        """Copy all cells from the values."""
        for slot in self.slots:
            at = self.text.op(f"getelementptr double, ptr %v, i64 {slot}")
            self.text.do(f"store double {self.text.op(f'load double, ptr {at}')}, ptr %s{slot}")

    def flush(self, slots: Iterable[int]) -> None:
        """Copy these cells back to the values."""
        for slot in slots:
            at = self.text.op(f"getelementptr double, ptr %v, i64 {slot}")
            self.text.do(f"store double {self.text.op(f'load double, ptr %s{slot}')}, ptr {at}")
