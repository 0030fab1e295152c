"""How the classes of nodes are made."""

from __future__ import annotations

from typing import Any, TypeVar, dataclass_transform

from desire_tui.engine.data_classes import dataclass, field

T = TypeVar("T")
_PLACE = ("start", "end")
"""Fields of every node that neither `==` nor `repr` looks at: where it stands is not what it says."""


@dataclass_transform(frozen_default=True)
def node(cls: type[T]) -> type[T]:
    """Make a slotted record class with the methods of a dataclass, frozen for the type checker only.

    Freezing at run time would cost another 1.5 µs a node.
    """
    own: dict[str, Any] = dict(vars(cls))
    for name in _PLACE:
        if name in own.get("__annotations__", ()):
            given = {"default": own[name]} if name in own else {}
            setattr(cls, name, field(repr=False, compare=False, **given))
    made: type[T] = dataclass(slots=True)(cls)
    return made


class Node:
    """Anything with a place in its statement."""

    __slots__ = ()
    start: int
    end: int
