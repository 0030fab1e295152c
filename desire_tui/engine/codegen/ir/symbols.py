"""Outside functions: the mathematical library's addresses under names that LLVM does not know.

Vectors use glibc's libmvec (at most 4 ulp off) where it has the function for the machine's vector width, and
else the scalar function lane by lane; quick and fast code call the same ones.
"""

from __future__ import annotations

import ctypes
import functools
from contextlib import suppress

from desire_tui.engine.codegen.ir.functions import C_FUNCTIONS

_MVEC_LETTER = {2: "b", 4: "d", 8: "e"}
_COMPARED = 300
TWO_ARGUMENTS = frozenset(("pow", "atan2"))


@functools.cache
def scalar_addresses() -> dict[str, int]:
    """Return the address of every library function, by its C name."""
    library = _mathematical_library()
    return {name: _address(library, name) for name in C_FUNCTIONS.values()}


@functools.cache
def _mathematical_library() -> ctypes.CDLL:
    try:
        return ctypes.CDLL("libm.so.6")
    except OSError:  # not glibc: `find_library` asks outside programs, which takes 15 ms
        from ctypes.util import find_library

        return ctypes.CDLL(find_library("m"))


@functools.cache
def vector_addresses(width: int) -> dict[str, int]:
    """Return the addresses of those functions that libmvec has for vectors of `width` doubles."""
    letter = _MVEC_LETTER.get(width)
    if letter is None:
        return {}
    try:
        library = ctypes.CDLL("libmvec.so.1")
    except OSError:
        return {}
    found = {}
    for name in C_FUNCTIONS.values():
        arguments = "vv" if name in TWO_ARGUMENTS else "v"
        try:
            found[name] = _address(library, f"_ZGV{letter}N{width}{arguments}_{name}")
        except AttributeError:
            continue
    return found


@functools.cache
def sine_and_cosine() -> int | None:
    """Return the address of the library's `sincos`; None: it is not there, or its bits are others."""
    library = _mathematical_library()
    try:
        both = library.sincos
    except AttributeError:
        return None
    both.argtypes, both.restype = (ctypes.c_double, ctypes.c_void_p, ctypes.c_void_p), None
    sine, cosine = ctypes.c_double(), ctypes.c_double()
    for alone in (library.sin, library.cos):
        alone.argtypes, alone.restype = (ctypes.c_double,), ctypes.c_double
    for k in range(_COMPARED):
        x = (-1.37) ** (k % 60) * (1 + 0.37 * k)
        both(x, ctypes.addressof(sine), ctypes.addressof(cosine))
        if (sine.value, cosine.value) != (library.sin(x), library.cos(x)):
            return None
    return _address(library, "sincos")


def process_address(name: str) -> int:
    """Return the address of a function that the process has loaded: memmove and the like. KeyError."""
    for library in (_process(), _mathematical_library()):
        with suppress(AttributeError):
            return _address(library, name)
    raise KeyError(name)


@functools.cache
def _process() -> ctypes.CDLL:
    return ctypes.CDLL(None)


def lane_by_lane(name: str, width: int) -> str:
    """Return the text of a vector function that calls the scalar one for each lane."""
    kind = f"<{width} x double>"
    count = 2 if name in TWO_ARGUMENTS else 1
    lines = []
    result = "poison"
    for lane in range(width):
        listed = []
        for k in range(count):
            lines.append(f"%a{lane}.{k} = extractelement {kind} %x{k}, i64 {lane}")
            listed.append(f"double %a{lane}.{k}")
        lines.append(f"%r{lane} = call double @desire.{name}.1({', '.join(listed)})")
        lines.append(f"%s{lane} = insertelement {kind} {result}, double %r{lane}, i64 {lane}")
        result = f"%s{lane}"
    arguments = ", ".join(f"{kind} %x{k}" for k in range(count))
    body = "\n".join(lines)
    head = f"define internal {kind} @desire.{name}.{width}({arguments}) #1"
    return f"{head} {{\n{body}\nret {kind} {result}\n}}"


def _address(library: ctypes.CDLL, name: str) -> int:
    return ctypes.cast(getattr(library, name), ctypes.c_void_p).value or 0
