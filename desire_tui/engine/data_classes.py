"""`dataclass`, `field` and `replace` as in the standard library's `dataclasses`, made quickly.

The library writes and compiles five methods for each class when its module is imported: 0.6 ms, and a short
program needs 66 classes of the engine (40 of the 400 ms of its processor time), most of whose methods nobody
calls. Here `__init__` is written when the first object is made, the other methods are closures, and the
library is not imported. To the type checker these are the library's own.

What differs: `frozen` holds for the type checker only (and makes `__hash__`); there is no `order`,
`kw_only` or `InitVar`. `dataclasses.fields`, `replace` and `asdict` know these classes too.
"""

from __future__ import annotations

from functools import partial
from operator import attrgetter
from reprlib import recursive_repr
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from dataclasses import dataclass, field, replace

T = TypeVar("T")
_NOTHING: Any = object()
_MADE: Any = object()
"""Given for an argument that a factory makes."""


class _Field:
    """What a class says of one of its fields."""

    __slots__ = ("compare", "default", "default_factory", "init", "repr")

    def __init__(
        self,
        *,
        default: object = _NOTHING,
        default_factory: Callable[[], object] = _NOTHING,
        init: bool = True,
        repr: bool = True,  # noqa: A002 - the library's word
        compare: bool = True,
    ) -> None:
        self.default, self.default_factory = default, default_factory
        self.init, self.repr, self.compare = init, repr, compare


def _dataclass(
    cls: type[T] | None = None,
    /,
    *,
    frozen: bool = False,
    eq: bool = True,
    repr: bool = True,  # noqa: A002 - the library's word
    slots: bool = False,
) -> Any:
    """Make a class a record of what its annotations name; `slots`: another class, the same but for them."""
    if cls is None:
        return partial(_dataclass, frozen=frozen, eq=eq, repr=repr, slots=slots)
    own = dict(vars(cls))
    names = [name for name, kind in own.get("__annotations__", {}).items() if not kind.startswith("ClassVar")]
    fields: dict[str, _Field] = {**getattr(cls, "_fields_of_class", {})}
    for name in names:
        said = own.get(name, _NOTHING)
        fields[name] = said if isinstance(said, _Field) else _Field(default=said)

    def __init__(self: Any, *args: object, **kwargs: object) -> None:  # noqa: N807 - it is one
        """Write the class's `__init__`, put it in this one's place, and call it."""
        made.__init__ = _written_init(made, fields)
        made.__init__(self, *args, **kwargs)

    added: dict[str, Any] = {
        "_fields_of_class": fields,
        "__match_args__": tuple(name for name, known in fields.items() if known.init),
        "__dataclass_fields__": _LibraryFields(),
        "__init__": __init__,
    }
    if repr:
        added["__repr__"] = _shown(tuple(name for name, known in fields.items() if known.repr))
    if eq:
        compared = tuple(name for name, known in fields.items() if known.compare)
        added["__eq__"], added["__hash__"] = _equality(compared, hashed=frozen)
    added = {name: value for name, value in added.items() if own.get(name) is None}
    made: Any = cls
    if slots:
        for name in (*names, "__dict__", "__weakref__"):
            own.pop(name, None)
        kind: Any = type(cls)
        made = kind(cls.__name__, cls.__bases__, {**own, "__slots__": tuple(names), **added})
        made.__qualname__ = cls.__qualname__
        return made
    for name, value in added.items():
        setattr(cls, name, value)
    for name in names:
        if isinstance(own.get(name), _Field):
            _leave_default(cls, name, fields[name])
    return made


def _leave_default(cls: type, name: str, known: _Field) -> None:
    """Let the class have as an attribute what the library would leave there: a default, no factory."""
    if known.default is _NOTHING:
        delattr(cls, name)
    else:
        setattr(cls, name, known.default)


def _written_init(cls: type, fields: Mapping[str, _Field]) -> Callable[..., None]:
    """Return an `__init__` that sets these fields, then calls `__post_init__` if there is one."""
    parameters, body = ["self"], []
    scope: dict[str, Any] = {"_made": _MADE}
    for name, known in fields.items():
        value = name
        if known.default_factory is not _NOTHING:
            scope[f"_{name}"] = known.default_factory
            value = f"_{name}() if {name} is _made else {name}" if known.init else f"_{name}()"
        elif known.default is not _NOTHING:
            scope[f"_{name}"] = known.default
            value = name if known.init else f"_{name}"
        elif not known.init:
            continue
        if known.init:
            default = "_made" if known.default_factory is not _NOTHING else f"_{name}"
            parameters.append(f"{name}={default}" if f"_{name}" in scope else name)
        body.append(f"\n self.{name} = {value}")
    if hasattr(cls, "__post_init__"):
        body.append("\n self.__post_init__()")
    text = f"def __init__({', '.join(parameters)}):{''.join(body) or ' pass'}"
    exec(text, scope)  # noqa: S102 - only names of fields go into the text
    made: Callable[..., None] = scope["__init__"]
    made.__qualname__ = f"{cls.__qualname__}.__init__"
    return made


def _shown(names: tuple[str, ...]) -> Callable[[Any], str]:
    def __repr__(self: Any) -> str:  # noqa: N807 - it is one
        return f"{type(self).__qualname__}({', '.join(f'{name}={getattr(self, name)!r}' for name in names)})"

    return recursive_repr()(__repr__)


def _equality(names: tuple[str, ...], *, hashed: bool) -> tuple[Callable[[Any, Any], bool], Any]:
    """Return `__eq__` and `__hash__` by the values of some fields."""
    values = attrgetter(*names) if len(names) > 1 else _few_values(names)

    def __eq__(self: Any, other: Any) -> bool:  # noqa: N807 - it is one
        return values(self) == values(other) if type(self) is type(other) else NotImplemented

    def __hash__(self: Any) -> int:  # noqa: N807 - it is one
        return hash(values(self))

    return __eq__, __hash__ if hashed else None


def _few_values(names: tuple[str, ...]) -> Callable[[Any], object]:
    return lambda value: tuple(getattr(value, name) for name in names)


class _LibraryFields:
    """What the library's functions look for in a class; made when one of them does."""

    def __get__(self, _: object, cls: Any) -> Any:
        import dataclasses

        fields = []
        for name, known in cls._fields_of_class.items():
            said = {word: getattr(known, word) for word in ("init", "repr", "compare")}
            for word in ("default", "default_factory"):
                if getattr(known, word) is not _NOTHING:
                    said[word] = getattr(known, word)
            fields.append((name, Any, dataclasses.field(**said)))
        return dataclasses.make_dataclass(cls.__name__, fields).__dataclass_fields__  # type: ignore[attr-defined]


def _replace(value: T, /, **changes: Any) -> T:
    """Return a copy with other values of some fields."""
    known: dict[str, _Field] | None = getattr(type(value), "_fields_of_class", None)
    if known is None:
        import dataclasses

        return dataclasses.replace(value, **changes)  # type: ignore[type-var]
    for name, about in known.items():
        if about.init and name not in changes:
            changes[name] = getattr(value, name)
    return type(value)(**changes)


if not TYPE_CHECKING:
    dataclass, field, replace = _dataclass, _Field, _replace

__all__ = ["dataclass", "field", "replace"]
