"""Types that plain Python is annotated with (`codegen.plain_python`), as a type checker sees them."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import ctypes
    from typing import Any

    Reals = ctypes._Pointer[ctypes.c_double]  # noqa: SLF001 - the type of what ctypes.POINTER makes
    Ints = ctypes._Pointer[ctypes.c_int64]  # noqa: SLF001
    Int32s = ctypes._Pointer[ctypes.c_int32]  # noqa: SLF001
    Int32 = int
    Address = Any
    Addresses = list[Any]

    cvode: ctypes.CDLL
