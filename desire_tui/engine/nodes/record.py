"""How the classes of nodes are made."""

from __future__ import annotations

from typing import Any, TypeVar, dataclass_transform

from desire_tui.engine.data_classes import dataclass

T = TypeVar("T")
_PLACE = ("start", "end")
"""Fields of every node that neither `==` nor `repr` looks at: where it stands is not what it says."""


@dataclass_transform(frozen_default=True)
def node(cls: type[T]) -> type[T]:
    """Make a `data_classes.dataclass` with slots, frozen for the type checker; its place is not compared."""
    methods: Any = cls
    methods.__eq__, methods.__repr__ = _equal, _shown
    return dataclass(slots=True)(cls)


def _equal(self: Any, other: Any) -> bool:
    if type(self) is not type(other):
        return NotImplemented  # type: ignore[no-any-return]  # the protocol of ==, no bool
    return all(getattr(self, name) == getattr(other, name) for name in self.__slots__ if name not in _PLACE)


def _shown(self: Any) -> str:
    parts = ", ".join(f"{name}={getattr(self, name)!r}" for name in self.__slots__ if name not in _PLACE)
    return f"{type(self).__name__}({parts})"


class Node:
    """Anything with a place in its statement."""

    __slots__ = ()
    start: int
    end: int
