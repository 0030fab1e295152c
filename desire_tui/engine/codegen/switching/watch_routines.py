"""The native functions that watch switches: one set for all models, kept on disk by the processor."""

from __future__ import annotations

import ctypes
import re
from ctypes import sizeof
from importlib.resources import files
from threading import Lock
from typing import TYPE_CHECKING, Any, NamedTuple

from desire_tui.engine.codegen.jit.compiler import compile_and_keep, kept_code
from desire_tui.engine.codegen.plain_python.kinds import of_function
from desire_tui.engine.codegen.plain_python.program import Module, write_program
from desire_tui.engine.codegen.plain_python.surroundings import Outside
from desire_tui.engine.digest import blake2b
from desire_tui.engine.integration import halving, hermite
from desire_tui.engine.integration.switching import (
    ahead,
    bounds,
    clearance,
    located,
    margins,
    memory,
    operations,
    watch,
)
from desire_tui.engine.integration.switching.memory import Compute, Place, Watch
from desire_tui.engine.lowered import switching as lowered_switching
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from desire_tui.engine.codegen.jit.machine_code import MachineCode

_MODULES = (hermite, bounds, ahead, margins, located, clearance, watch)
_ENGINE = files("desire_tui.engine")


def _source(name: str) -> bytes:
    return (_ENGINE / f"{name.partition('.engine.')[2].replace('.', '/')}.py").read_bytes()


_TEXTS = {module: _source(module.__name__) for module in _MODULES}
_OTHERS = b"".join(_source(module.__name__) for module in (memory, operations, halving, lowered_switching))
_PUBLIC = ("begin", "limit", "look_back", "look_at_step", "place_on_step", "settle", "depart", "follow")
_BEGIN = ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_void_p, ctypes.c_double)
_making = Lock()
_made: list[WatchFunctions] = []


class WatchFunctions(NamedTuple):
    """Addresses of the functions of `integration.switching.watch`; `keep` owns the code."""

    begin_at: int
    limit: int
    look_back: int
    look_at_step: int
    place_on_step: int
    settle: int
    depart: int
    follow: int
    keep: Any

    def begin(self, watch: Watch, t: float) -> None:
        """Call `watch.begin`."""
        _BEGIN(self.begin_at)(ctypes.addressof(watch), t)


def watch_functions() -> WatchFunctions:
    """Return the functions; the first call of a process compiles them, or finds them on disk."""
    with _making:
        if not _made:
            _made.append(_found(kept_code(_name()) or _compiled()))
        return _made[0]


def _compiled() -> MachineCode:
    pointers = {name: of_function(kind, "") for name, kind in
                (("modes", Compute), ("derivative", Compute), ("place", Place))}  # fmt: skip
    outside = Outside({"Watch": Watch}, pointers)
    modules = [Module(_TEXTS[module], vars(module)) for module in _MODULES]
    text = write_program(modules, outside, "watch_", frozenset(_PUBLIC))
    return compile_and_keep(text, _name(), level=2, vectorize=True)


def _name() -> str:
    layout = repr((T, sizeof(Watch), Watch._fields_, _PUBLIC))
    everything = b"".join(_TEXTS.values()) + _OTHERS + re.sub(" at 0x[0-9a-f]+", "", layout).encode()
    return f"watch-{blake2b(everything, digest_size=8).hexdigest()}"


def _found(code: MachineCode) -> WatchFunctions:
    return WatchFunctions._make([*(code.address(f"watch_{name}") for name in _PUBLIC), code])
