"""`runtime.moments` as native functions: one set for all models, kept on disk by the processor."""

from __future__ import annotations

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
from desire_tui.engine.integration import halving, tableaus
from desire_tui.engine.integration.switching import memory as switching
from desire_tui.engine.integration.taylor import isolation
from desire_tui.engine.integration.taylor import memory as taylor_memory
from desire_tui.engine.integration.taylor.memory import Taylor
from desire_tui.engine.runtime import run_memory
from desire_tui.engine.runtime.moments import (
    along,
    blocks,
    histories,
    inside,
    locate,
    memory,
    side_by_side,
    stages,
    steps,
)
from desire_tui.engine.runtime.moments.memory import (
    Compute,
    Depart,
    Limit,
    Look,
    Moments,
    Place,
    Settle,
    SideBySide,
)
from desire_tui.engine.runtime.run_memory import RunMemory
from desire_tui.engine.values import DT, ERRMAX, T

if TYPE_CHECKING:
    from desire_tui.engine.codegen.jit.machine_code import MachineCode

_MODULES = (histories, blocks, stages, locate, steps, inside, isolation, along, side_by_side)
_ENGINE = files("desire_tui.engine")


def _source(name: str) -> bytes:
    return (_ENGINE / f"{name.partition('.engine.')[2].replace('.', '/')}.py").read_bytes()


_TEXTS = {module: _source(module.__name__) for module in _MODULES}
"""Read now, when the modules are: files may change under a process that lives for days."""
_LAYOUTS = (memory, run_memory, tableaus, halving, switching, taylor_memory)
_OTHERS = b"".join(_source(module.__name__) for module in _LAYOUTS)
_PUBLIC = (
    "begin",
    "step",
    "look_up",
    "limit_step",
    "look_inside",
    "remember_step",
    "happen",
    "look_along_series",
    "cut_short",
    "begin_runs",
    "step_runs",
    "record_runs",
    "look_up_runs",
)
_STRUCTURES = (Moments, RunMemory, Taylor, SideBySide)
_making = Lock()
_made: list[MomentFunctions] = []


class MomentFunctions(NamedTuple):
    """Addresses; `keep` owns the code."""

    begin: int
    step: int
    look_up: int
    limit_step: int
    look_inside: int
    remember_step: int
    happen: int
    look_along_series: int
    cut_short: int
    begin_runs: int
    step_runs: int
    record_runs: int
    look_up_runs: int
    keep: Any


def moment_functions() -> MomentFunctions:
    """Return the functions; the first call of a process compiles them, or finds them on disk."""
    with _making:
        if not _made:
            code = kept_code(_name()) or _compiled()
            addresses = [code.address(f"moments_{name}") for name in _PUBLIC]
            _made.append(MomentFunctions._make([*addresses, code]))
        return _made[0]


def _compiled() -> MachineCode:
    pointers = {name: of_function(Compute, "") for name in ("conditions", "blocks", "derivative", "sources")}
    kinds = {"limit": Limit, "look": Look, "depart": Depart, "settle": Settle, "place": Place}
    pointers |= {name: of_function(kind, "") for name, kind in kinds.items()}
    outside = Outside({kind.__name__: kind for kind in _STRUCTURES}, pointers)
    modules = [Module(_TEXTS[module], vars(module)) for module in _MODULES]
    text = write_program(modules, outside, "moments_", frozenset(_PUBLIC))
    return compile_and_keep(text, _name(), level=1, vectorize=False)


def _name() -> str:
    layout = repr((T, DT, ERRMAX, *((kind, sizeof(kind), kind._fields_) for kind in _STRUCTURES)))
    everything = b"".join(_TEXTS.values()) + _OTHERS + re.sub(" at 0x[0-9a-f]+", "", layout).encode()
    return f"moments-{blake2b(everything, digest_size=8).hexdigest()}"
