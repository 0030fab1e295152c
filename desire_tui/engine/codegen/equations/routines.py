"""The native code of `model_functions`: one set for all models, kept on disk by the processor."""

from __future__ import annotations

import re
from ctypes import sizeof
from importlib.resources import files
from threading import Lock
from typing import TYPE_CHECKING, Any, NamedTuple

from desire_tui.engine.codegen.equations import model_functions
from desire_tui.engine.codegen.jit.compiler import compile_and_keep, kept_code
from desire_tui.engine.codegen.plain_python.kinds import of_declaration
from desire_tui.engine.codegen.plain_python.program import Module, write_program
from desire_tui.engine.codegen.plain_python.surroundings import Outside
from desire_tui.engine.codegen.stiff import jacobian_fill, model_calls
from desire_tui.engine.digest import blake2b
from desire_tui.engine.integration import problem
from desire_tui.engine.integration.problem import FUNCTIONS, SolverProblem
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from types import ModuleType

    from desire_tui.engine.codegen.jit.machine_code import MachineCode

_MODULES = (model_calls, jacobian_fill, model_functions)
_ENGINE = files("desire_tui.engine")
_making = Lock()
_made: list[EquationFunctions] = []


def _source(module: ModuleType) -> bytes:
    return (_ENGINE / f"{module.__name__.partition('.engine.')[2].replace('.', '/')}.py").read_bytes()


_TEXTS = {module: _source(module) for module in _MODULES}
_PUBLIC = ("right_hand_side", "right_hand_sides", "jacobian")


class EquationFunctions(NamedTuple):
    """Addresses of the functions of `model_functions`; `keep` owns the code."""

    right_hand_side: int
    right_hand_sides: int
    jacobian: int
    keep: Any


def equation_functions() -> EquationFunctions:
    """Return the functions; the first call of a process compiles them, or finds them on disk."""
    with _making:
        if not _made:
            code = kept_code(_name()) or _compiled()
            _made.append(
                EquationFunctions._make([*(code.address(f"equations_{name}") for name in _PUBLIC), code])
            )
        return _made[0]


def _compiled() -> MachineCode:
    pointers = {name: of_declaration(*kinds, "") for name, kinds in FUNCTIONS.items()}
    outside = Outside({"SolverProblem": SolverProblem}, pointers)
    modules = [Module(_TEXTS[module], vars(module)) for module in _MODULES]
    text = write_program(modules, outside, "equations_", frozenset(_PUBLIC))
    return compile_and_keep(text, _name(), level=1, vectorize=False)


def _name() -> str:
    layout = repr((T, sizeof(SolverProblem), SolverProblem._fields_))
    everything = b"".join(
        (*_TEXTS.values(), _source(problem), re.sub(" at 0x[0-9a-f]+", "", layout).encode())
    )
    return f"equations-{blake2b(everything, digest_size=8).hexdigest()}"
