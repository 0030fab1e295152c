"""A cache that forgets what has not been asked for lately; its owner says when it may."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable

Key = TypeVar("Key")
Value = TypeVar("Value")

_PROGRAMS_MOST = 20
"""How many times the room one program may take before the cache forgets in the middle of it."""


class RecentlyUsed(dict[Key, "Value | None"]):
    """`cache[key]` is what was kept for a key, or None. A look-up costs no more than a dictionary's.

    Two generations: `age`, called between two programs, drops what was not asked for since the generation
    before it filled its `room`. So a program larger than the room still finds all of its entries at its next
    turn, and memory stays bounded by twice the room or twice the largest program.

    Caches of this kind may serve all threads and sessions: what they keep depends on its key alone.
    """

    __slots__ = ("_cost", "_older", "_room", "_used")

    def __init__(self, room: int, cost: Callable[[Key], int] | None = None) -> None:
        super().__init__()
        self._room = room
        self._cost = cost
        self._used = 0
        self._older: dict[Key, Value | None] = {}

    def __missing__(self, key: Key) -> Value | None:
        """Look among the older entries; what is found there stays for another generation."""
        found = self._older.get(key)
        if found is not None:
            self.keep(key, found)
        return found

    def keep(self, key: Key, value: Value) -> None:
        """Keep a value."""
        self[key] = value
        self._used += 1 if self._cost is None else self._cost(key)
        if self._used > _PROGRAMS_MOST * self._room:
            self._begin_generation()

    def age(self) -> None:
        """Forget what nobody asked for lately, if there is no more room."""
        if self._used > self._room:
            self._begin_generation()

    def forget(self) -> None:
        """Forget everything."""
        self._older = {}
        self.clear()
        self._used = 0

    @property
    def size(self) -> int:
        """How many entries are kept."""
        return len(self.keys() | self._older.keys())

    def _begin_generation(self) -> None:
        self._older = self.copy()
        self.clear()
        self._used = 0
