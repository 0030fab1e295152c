"""Types of plain Python: what annotations, ctypes' fields and LLVM call them."""

from __future__ import annotations

import ctypes
from typing import Any, NamedTuple


class Kind(NamedTuple):
    """A type: LLVM's name for it and, for pointers, what they point at."""

    ir: str
    of: str = ""
    """LLVM's name of an array's elements."""
    structure: type[ctypes.Structure] | None = None

    def __str__(self) -> str:
        """Return what messages call it."""
        if self.structure is not None:
            return self.structure.__name__
        return _ARRAYS[self.of] if self.of else _NAMES[self.ir]


class Value(NamedTuple):
    """A value in a function's text."""

    text: str
    kind: Kind


class Signature(NamedTuple):
    """A function: its name in LLVM, the type of its result (None: it has none), its arguments' types."""

    symbol: str
    result: Kind | None
    arguments: tuple[Kind, ...]

    def declaration(self) -> str:
        """Return LLVM's declaration of a function that stands elsewhere."""
        return f"declare {self.returns} @{self.symbol}({', '.join(kind.ir for kind in self.arguments)})"

    @property
    def returns(self) -> str:
        """LLVM's name of the result's type."""
        return "void" if self.result is None else self.result.ir


INT, REAL, FLAG, ADDRESS = Kind("i64"), Kind("double"), Kind("i1"), Kind("ptr")
INT32 = Kind("i32")
"""Only at a function's border and in memory: values are widened at once."""
NUMBERS = (INT, REAL, FLAG)

_NAMES = {"i64": "int", "double": "float", "i1": "bool", "ptr": "an address", "i32": "Int32"}
_ARRAYS = {"double": "Reals", "i64": "Ints", "i32": "Int32s", "ptr": "Addresses"}
ANNOTATIONS = {name: Kind("ptr", of) for of, name in _ARRAYS.items()} | {
    "int": INT, "float": REAL, "bool": FLAG, "Int32": INT32, "Address": ADDRESS
}  # fmt: skip

_SCALARS: dict[Any, Kind] = {
    ctypes.c_double: REAL, ctypes.c_int64: INT, ctypes.c_int32: INT32, ctypes.c_uint64: ADDRESS,
    ctypes.c_void_p: ADDRESS,
}  # fmt: skip


def of_field(declared: Any) -> Kind | None:
    """Return the type of a C structure's field; None for one that plain Python does not know."""
    if declared in _SCALARS:
        return _SCALARS[declared]
    if hasattr(declared, "_argtypes_"):
        return ADDRESS
    element = _SCALARS.get(getattr(declared, "_type_", None))
    return Kind("ptr", element.ir) if element is not None else None


def of_function(declared: Any, symbol: str) -> Signature:
    """Return the signature of one of ctypes' function types; every pointer is an address."""
    return of_declaration(declared._restype_, declared._argtypes_, symbol)


def of_declaration(result: Any, arguments: tuple[Any, ...], symbol: str) -> Signature:
    """Return the signature of a C function declared with ctypes' types."""
    return Signature(
        symbol, None if result is None else _scalar(result), tuple(_scalar(kind) for kind in arguments)
    )


def _scalar(declared: Any) -> Kind:
    return _SCALARS.get(declared, ADDRESS)
