"""Functions of many numbers with the C library's bits: compiled, tried beside the library, and kept.

The rounding test rests on what glibc says of its own accuracy; where operations are repeated one by one, the
library has to be made of them. Neither can be read off the library at hand, so each function is compared
with it before its first use in a process. Where a bit differs, or nothing is known of the library, there is
no function, and the library is called number by number.
"""

from __future__ import annotations

import ctypes
import os
from threading import Lock
from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.codegen.exact_functions.vector_functions import NAMES, ways, written
from desire_tui.engine.codegen.jit.compiler import compile_and_keep, kept_code, machine, module_text
from desire_tui.engine.digest import blake2b

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from desire_tui.engine.codegen.jit.machine_code import MachineCode

    Floats = NDArray[np.float64]

_GLIBC = (2, 28)
"""Since then sin, cos, exp and log are those whose operations or accuracy are relied on."""
_TRIED = 16_384
_TELLING = """
0x1.a91d7b5e68ef8p+15 0x1.1af155ab6de09p+15 0x1.28039a4f07325p+4 0x1.fa5d92568c154p+3 0x1.95cebb57e8688p+2
0x1.1ee2ae30ed4bcp+19 0x1.6d46292e8eac8p+0 0x1.188184b5e0045p+4 0x1.acff067e4d078p+3 0x1.f4bffa439719ap-1
0x1.a5eed01827bd9p+0 0x1.34b95b2ebd498p+2 0x1.c8a372b2a2527p+16
0x1.d40f330175377p-1 0x1.141061eec33e1p+0 0x1.11f07bfbf8a4cp+0 0x1.1390e8f39e3e2p+0 0x1.21fd5fd7f95bcp+0
0x1.c3e6fa5665928p-1 0x1.cff86bd267f6ep-1 0x1.100ae9e16766ep+0 0x1.dff4dd3dc461ap-1 0x1.146a1ff66ec44p+0
"""
"""Where a sin (the first 6) or cos (7) would differ whose compiler had fused the other one of two products in
a sum; and where glibc's log (10) is most off."""
_TRY = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int64)
_lock = Lock()
_known: dict[tuple[str, int], ExactFunction | None] = {}


class ExactFunction:
    """A function of `width` doubles that code may call by its `symbol`."""

    def __init__(self, symbol: str, code: MachineCode, library: Sequence[str]) -> None:
        """`library` are the functions whose results it gives."""
        self.symbol, self._code, self._library = symbol, code, library

    def of(self, x: Floats) -> Floats:
        """Return the results (functions, numbers); the numbers are a multiple of the width."""
        found = np.empty((len(self._library), len(x)))
        _TRY(self._code.address("try"))(x.ctypes.data, found.ctypes.data, len(x))
        return found

    def is_exact(self) -> bool:
        """Whether it gives the library's bits for all arguments tried."""
        x = _arguments()
        found = self.of(x)
        wanted = np.empty_like(found)
        for number, name in enumerate(self._library):
            _TRY(self._code.address(f"try.{name}"))(x.ctypes.data, wanted[number].ctypes.data, len(x))
        same = found.view(np.int64) == wanted.view(np.int64)
        return bool((same | (np.isnan(found) & np.isnan(wanted))).all())

    def register(self) -> None:
        """Let code call it."""
        machine().add_symbol(self.symbol, self._code.address(self.symbol))


def widest(name: str) -> int:
    """Return how many doubles at a time give most: in tanh's long chain each waits for the one before."""
    return (4 if name == "tanh" else 2) * machine().width


def exact_function(name: str, width: int) -> ExactFunction | None:
    """Return a function of `width` doubles; None: there is none with the library's bits."""
    with _lock:
        key = name, width
        if key not in _known:
            _known[key] = _made(name, width) if _is_possible(name) else None
        return _known[key]


def _is_possible(name: str) -> bool:
    if name not in NAMES or "+fma" not in machine().features.split(","):
        return False
    try:
        library, _, version = os.confstr("CS_GNU_LIBC_VERSION").partition(" ")  # type: ignore[union-attr]  # None: caught
        found = tuple(int(part) for part in version.split(".")[:2])
    except (AttributeError, ValueError, OSError):  # not glibc
        return False
    return library == "glibc" and found >= _GLIBC


def _made(name: str, width: int) -> ExactFunction | None:
    for way in ways(name):
        symbol = f"exact.{name}.{width}"
        function = written(name, symbol, width, way)
        trials = _trials(symbol, width, function.library)
        text = module_text([function.text, *trials], function.needs)
        kept_name = f"exact-{blake2b(text.encode(), digest_size=8).hexdigest()}"
        code = kept_code(kept_name) or compile_and_keep(text, kept_name, level=2, vectorize=False)
        made = ExactFunction(symbol, code, function.library)
        if made.is_exact():
            made.register()
            return made
    return None


def _trials(symbol: str, width: int, library: Sequence[str]) -> list[str]:
    """Return loops over arguments: `try` by the function, `try.NAME` by the library; results side by side."""
    kind = f"<{width} x double>"
    results = len(library)
    many = f"{{ {kind}, {kind} }}" if results > 1 else kind
    lines = [f"%all = call {many} @{symbol}({kind} %x)"]
    for number in range(results):
        value = "%all"
        if results > 1:
            value = f"%r{number}"
            lines.append(f"{value} = extractvalue {many} %all, {number}")
        lines += [
            f"%j{number} = mul i64 %n, {number}",
            f"%k{number} = add i64 %i, %j{number}",
            f"%q{number} = getelementptr double, ptr %out, i64 %k{number}",
            f"store {kind} {value}, ptr %q{number}, align 8",
        ]
    own = _LOOP.format(name="try", kind=kind, width=width, body="\n".join(lines))
    others = [
        _LOOP.format(
            name=f"try.{each}", kind="double", width=1,
            body=f"%y = call double @desire.{each}.1(double %x)\n"
            "%q = getelementptr double, ptr %out, i64 %i\nstore double %y, ptr %q",
        )
        for each in library
    ]  # fmt: skip
    return [own, *others]


_LOOP = """define void @{name}(ptr %in, ptr %out, i64 %n) #0 {{
entry:
  br label %next
next:
  %i = phi i64 [ 0, %entry ], [ %more, %next ]
  %p = getelementptr double, ptr %in, i64 %i
  %x = load {kind}, ptr %p, align 8
  {body}
  %more = add i64 %i, {width}
  %again = icmp slt i64 %more, %n
  br i1 %again, label %next, label %done
done:
  ret void
}}"""


def _arguments() -> Floats:
    """Return numbers spread over everything: where functions are used most, all sizes, what is special."""
    golden = (np.arange(_TRIED) * 0.6180339887498949) % 1.0
    near = 40.0 * golden[: _TRIED // 2] - 20.0
    near[::8] = 1.0 + near[::8] ** 3 * 1e-5  # where logarithms are small
    near.sort()  # side by side they are alike, as those of runs are: what is jumped over then, is jumped over
    part = golden[_TRIED // 2 :]
    signs = np.where(np.arange(len(part)) % 2, 1.0, -1.0)
    far = signs * 10.0 ** (12.0 * part - 6.0)
    special = [0.0, -0.0, np.inf, -np.inf, np.nan, 1.0, -1.0, 5e-324, 1e300, np.pi, np.pi / 2, 710.0, -746.0]
    telling = [float.fromhex(number) for number in _TELLING.split()]
    return np.concatenate([near, far, np.resize(np.array([*special, *telling]), 64)])
