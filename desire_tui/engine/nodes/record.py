"""How the classes of nodes are made."""

from __future__ import annotations

from typing import Any, TypeVar, dataclass_transform

T = TypeVar("T")
_PLACE = ("start", "end")
"""Fields of every node that neither `==` nor `repr` looks at: where it stands is not what it says."""


@dataclass_transform(frozen_default=True)
def node(cls: type[T]) -> type[T]:
    """Make a slotted record class with the methods of a dataclass, frozen for the type checker only.

    Why not `dataclass(slots=True)`: its generated methods for these 63 classes cost 40 ms at every start,
    so here `__init__` is generated when a class is first used. Freezing at run time would cost another 1.5
    µs a node.
    """
    own = dict(vars(cls))
    names = tuple(own.get("__annotations__", ()))
    defaults = {name: own.pop(name) for name in names if name in own}
    for unwanted in ("__dict__", "__weakref__"):
        own.pop(unwanted, None)
    own.update(
        __slots__=names,
        __match_args__=names,
        __init__=_first_init,
        __eq__=_equal,
        __repr__=_shown,
        __hash__=None,
        _defaults_=defaults,
    )
    made: type[T] = type(cls.__name__, cls.__bases__, own)
    return made


def _first_init(self: Any, *args: object, **kwargs: object) -> None:
    """Generate the class's `__init__`, put it in this one's place, and call it."""
    cls = type(self)
    parameters = ", ".join(f"{name}=_{name}" if name in cls._defaults_ else name for name in cls.__slots__)
    body = "".join(f"\n self.{name} = {name}" for name in cls.__slots__) or " pass"
    scope = {f"_{name}": value for name, value in cls._defaults_.items()}
    exec(f"def __init__(self, {parameters}):{body}", scope)  # noqa: S102 - only names of fields go into the text
    cls.__init__ = scope["__init__"]
    cls.__init__(self, *args, **kwargs)


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
