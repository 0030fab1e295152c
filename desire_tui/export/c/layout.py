"""Where numbers stand in the C file: the slots that a run uses, packed into one array, and their names."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from desire_tui.engine.values import SYSTEM_SLOTS

if TYPE_CHECKING:
    from desire_tui.engine.values import Values

_NOT_C = re.compile(r"\W", re.ASCII)


class Layout:
    """Slots are taken as statements name them; `place` gives their C text. Arrays stay in one piece."""

    def __init__(self, values: Values) -> None:
        self._values = values
        self._owner: dict[int, tuple[int, int, str]] = {}
        """First slot, count and name of what a slot belongs to."""
        for quantity in values:
            count = 1
            for size in quantity.shape:
                count *= size
            for slot in range(quantity.slot, quantity.slot + count) if count <= 1 << 20 else (quantity.slot,):
                self._owner.setdefault(slot, (quantity.slot, count, quantity.name))
        self._offsets: dict[int, int] = {}
        self._taken: list[tuple[int, int, str]] = []
        self._size = 0
        for slot in range(SYSTEM_SLOTS):
            self.offset(slot, 1)

    @property
    def size(self) -> int:
        """How many numbers there are."""
        return self._size

    def offset(self, slot: int, count: int) -> int:
        """Return where `count` numbers from a slot on stand in the C array."""
        begin, length, name = self._owner.get(slot, (slot, count, ""))
        length = max(length, slot + count - begin)
        if begin not in self._offsets:
            self._offsets[begin] = self._size
            self._taken.append((begin, length, name))
            self._size += length
        return self._offsets[begin] + slot - begin

    def place(self, slot: int) -> str:
        """Return the text of a number."""
        begin, length, name = self._owner.get(slot, (slot, 1, ""))
        offset = self.offset(slot, 1)
        if not name:
            return f"v[{offset}]"
        return self._macro(name) if length == 1 else f"{self._macro(name)}[{slot - begin}]"

    def pointer(self, slot: int, count: int) -> str:
        """Return the text of the address of several."""
        begin, length, name = self._owner.get(slot, (slot, count, ""))
        offset = self.offset(slot, count)
        if not name or length == 1:
            return f"(v + {offset})"
        return self._macro(name) if slot == begin else f"({self._macro(name)} + {slot - begin})"

    def macros(self) -> str:
        """Return the names of all numbers as C's preprocessor has them."""
        lines = []
        for begin, length, name in self._taken:
            if name:
                where = f"v[{self._offsets[begin]}]" if length == 1 else f"(v + {self._offsets[begin]})"
                lines.append(f"#define {self._macro(name)} {where}")
        return "\n".join(lines)

    def initial(self) -> list[float]:
        """Return all numbers as they are now."""
        numbers = [0.0] * self._size
        for begin, length, _ in self._taken:
            at = self._offsets[begin]
            numbers[at : at + length] = self._values.data[begin : begin + length].tolist()
        return numbers

    @staticmethod
    def _macro(name: str) -> str:
        return f"q_{_NOT_C.sub('_', name)}"
