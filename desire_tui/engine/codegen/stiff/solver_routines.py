"""Makes the model-independent native routines of rules 9 … 16, once a process, some once a machine."""

from __future__ import annotations

import re
from collections import defaultdict
from ctypes import sizeof
from functools import lru_cache
from importlib.resources import files
from threading import Lock
from typing import TYPE_CHECKING, Any, NamedTuple

from desire_tui.engine.codegen.jit.compiler import compile_and_keep, compile_text, kept_code, machine
from desire_tui.engine.codegen.plain_python.kinds import Signature, of_declaration, of_function
from desire_tui.engine.codegen.plain_python.program import Module, write_program
from desire_tui.engine.codegen.plain_python.surroundings import Outside
from desire_tui.engine.codegen.stiff import (
    cvode_callbacks,
    cvode_steps,
    explicit_steps,
    interval,
    jacobian_fill,
    look_back,
    model_calls,
    moment_steps,
    own_steps,
    progress,
    rounding,
    taylor_steps,
)
from desire_tui.engine.digest import blake2b
from desire_tui.engine.integration import hermite, problem, sliding
from desire_tui.engine.integration.bdf import choice, coefficients, memory, newton, start, step
from desire_tui.engine.integration.bdf.memory import Bdf, Evaluate, Fill, Weigh
from desire_tui.engine.integration.explicit import memory as explicit_memory
from desire_tui.engine.integration.explicit import step as explicit_step
from desire_tui.engine.integration.explicit.memory import Explicit
from desire_tui.engine.integration.problem import FUNCTIONS, SolverProblem
from desire_tui.engine.integration.sundials import signatures
from desire_tui.engine.integration.sundials.library import libraries
from desire_tui.engine.integration.sundials.signatures import CVODE, address
from desire_tui.engine.integration.switching import located
from desire_tui.engine.integration.switching import memory as switching
from desire_tui.engine.integration.switching.memory import Compute, Place, Watch
from desire_tui.engine.integration.taylor import isolation, roots, shared_steps, square_roots
from desire_tui.engine.integration.taylor import memory as taylor_memory
from desire_tui.engine.integration.taylor import step as taylor_step
from desire_tui.engine.integration.taylor.memory import Expand, Share, Taylor
from desire_tui.engine.recently_used import RecentlyUsed
from desire_tui.engine.runtime import run_memory
from desire_tui.engine.runtime.moments import inside as moments_inside
from desire_tui.engine.runtime.moments import memory as moments_memory
from desire_tui.engine.runtime.moments import steps as moments_steps
from desire_tui.engine.runtime.moments.memory import Moments
from desire_tui.engine.runtime.run_memory import RunMemory
from desire_tui.engine.values import DT, T

if TYPE_CHECKING:
    from types import ModuleType

    from desire_tui.engine.codegen.jit.machine_code import MachineCode

_CALLED = (
    "CVode", "CVodeGetDky", "CVodeReInit", "CVodeSetInitStep", "CVodeSetStopTime", "CVodeGetLastStep",
    "CVodeGetNumErrTestFails", "CVodeGetNumStepSolveFails", "CVodeSetJacEvalFrequency",
    "CVodeSetNonlinConvCoef",
)  # fmt: skip
_MODEL = (model_calls, jacobian_fill, rounding, sliding, moment_steps, progress, interval)
_CVODE = (*_MODEL, look_back, cvode_callbacks, cvode_steps)
_OWN = (*_MODEL, look_back, own_steps, choice, coefficients, newton, start, step)
_TAYLOR = (*_MODEL, taylor_steps, taylor_step, shared_steps, square_roots, isolation, roots, located)
_EXPLICIT = (*_MODEL, look_back, explicit_steps, explicit_step, hermite)
_CONSTANTS = (
    memory, explicit_memory, taylor_memory, problem, run_memory, signatures, switching, moments_inside,
    moments_memory, moments_steps,
)  # fmt: skip
_ENGINE = files("desire_tui.engine")


def _source(module: ModuleType) -> bytes:
    return (_ENGINE / f"{module.__name__.partition('.engine.')[2].replace('.', '/')}.py").read_bytes()


def _sources(folder: str) -> list[bytes]:
    found = [file for file in (_ENGINE / folder).iterdir() if file.name.endswith(".py")]
    return [file.read_bytes() for file in sorted(found, key=lambda file: file.name)]


_TEXTS = {module: _source(module) for module in (*_CVODE, *_OWN, *_TAYLOR, *_EXPLICIT)}
"""Read now, when the modules are: files may change under a process that lives for days."""
_DEPENDS_ON = b"".join(
    (*_TEXTS.values(), *map(_source, _CONSTANTS), *_sources("codegen/plain_python"), *_sources("codegen/ir"))
)
"""Kept code of other texts is not looked at."""

_STRUCTURES = (Bdf, Explicit, SolverProblem, RunMemory, Taylor, Watch, Moments)
_ANY = 0
"""In place of a number of states: code for all."""
_SERIES = -1
"""In place of a number of states: the solver of rule 17."""
_VARIABLE = -2
"""In place of a number of states: the solver of rules 4, 7 and 8."""
NEVER_IN_SMOOTH_MODELS = {"watch": 0, "moments": 0, "step": 0, "input_count": 0}
"""Fields of a `SolverProblem` in which nothing switches, no event comes, no delay looks back, and no code at
steps or points changes what derivatives read: most models. Asking would take 5 % of their steps' time."""
_RARE = frozenset(("scatter_ranges", "excuse_noise", "search_noise", "begin_anew"))
"""Functions whose code would only make the steps' longer."""
_OWN_LEVEL = 2
"""Level of optimisation of our solvers."""
_FAST = 1
"""Level of optimisation of what goes with CVODE: level 2 gains nothing there."""
SIZES_KEPT = 16
"""Code for one number of states takes 0.3 MB; a study of many sizes comes back to few of them."""
LARGE = 200
"""More states than this are worth 0.1 s of optimisation; fewer get quick code after 0.02 s."""


class StiffFunctions(NamedTuple):
    """Addresses (`state_at`: a `switching.memory.Place`); `keep` owns the code.

    CVODE's callbacks are 0 where `integration.bdf` makes the steps.
    """

    interval: int
    rhs: int
    weights: int
    jacobian: int
    state_at: int
    keep: Any


class SolverRoutines:
    """Made when they are wanted, then kept."""

    def __init__(self) -> None:
        self._connected = False
        self._cvode: dict[int, StiffFunctions] = {}
        """By level of optimisation."""
        self._own = RecentlyUsed[tuple[int, bool], StiffFunctions](SIZES_KEPT)
        """By number of states, and whether for smooth models; a run that goes on keeps its own."""
        self._locks = defaultdict[tuple[str, int], Lock](Lock)
        """By level or number of states: several sessions may ask for the same, none waits for another's."""

    def first(self, n: int, *, own: bool, smooth: bool = False) -> StiffFunctions:
        """Return what a run can start with: with CVODE quick code for few states; our solver compiled well.

        That takes half a second once a machine, for all numbers of states; quick code would take 2.5 times as
        long for each run. `smooth`: for models in which nothing of `NEVER_IN_SMOOTH_MODELS` happens.
        """
        if not own:
            return self._with_cvode(_FAST if n > LARGE else 0)
        return self._kept(n, smooth=smooth) or self._kept(_ANY) or self._make_own(_ANY)

    def fast(self, n: int, *, own: bool, smooth: bool = False) -> StiffFunctions:
        """Compile the fastest code for n states (0.1 s; our solver, for just this n, 1 s once a machine)."""
        if not own:
            return self._with_cvode(_FAST)
        return self._kept(n, smooth=smooth) or self._make_own(n, smooth=smooth)

    def series(self) -> StiffFunctions:
        """Return the solver of rule 17, compiled well once a machine: a single run may take long."""
        return self._kept(_SERIES) or self._make_own(_SERIES)

    def variable(self) -> StiffFunctions:
        """Return the solver of rules 4, 7 and 8, compiled well once a machine."""
        return self._kept(_VARIABLE) or self._make_own(_VARIABLE)

    def _with_cvode(self, level: int) -> StiffFunctions:
        self._connect()
        with self._locks["level", level]:
            if level not in self._cvode:
                self._cvode[level] = _found(compile_text(_cvode_text(), level=level, keep=True), own=False)
            return self._cvode[level]

    def _make_own(self, n: int, *, smooth: bool = False) -> StiffFunctions:
        """Compile our solver for n states, `_ANY` number of them: vector code gains nothing for that."""
        with self._locks["states", n]:
            if (found := self._own[n, smooth]) is None:
                text = _text(n, smooth=smooth)
                code = compile_and_keep(text, _name(n, smooth=smooth), level=_OWN_LEVEL, vectorize=n != _ANY)
                found = self._keep(n, code, smooth=smooth)
            return found

    def _kept(self, n: int, *, smooth: bool = False) -> StiffFunctions | None:
        """Return our solver's fast code for n states if this process or another one has made it."""
        found = self._own[n, smooth]
        if found is None:
            code = kept_code(_name(n, smooth=smooth))
            if code is not None:
                found = self._keep(n, code, smooth=smooth)
        return found

    def _keep(self, n: int, code: MachineCode, *, smooth: bool) -> StiffFunctions:
        found = _found(code, own=True)
        self._own.age()
        self._own.keep((n, smooth), found)
        return found

    def _connect(self) -> None:
        """Tell LLVM where CVODE's functions are. DesireError 460, 461: no SUNDIALS."""
        if self._connected:
            return
        cvode = libraries().cvode
        host = machine()
        for name in _CALLED:
            host.add_symbol(name, address(cvode, name))
        self._connected = True


@lru_cache(2 * SIZES_KEPT)
def _name(n: int, *, smooth: bool = False) -> str:
    layouts = repr(
        [
            T,
            DT,
            *((kind, sizeof(kind), kind._fields_) for kind in _STRUCTURES),
        ]
    )
    everything = _DEPENDS_ON + re.sub(" at 0x[0-9a-f]+", "", layouts).encode()
    digest = blake2b(everything, digest_size=8).hexdigest()
    return f"bdf-{_OWN_LEVEL}-{n}{'-smooth' if smooth else ''}-{digest}"


def _modules(modules: tuple[ModuleType, ...]) -> list[Module]:
    return [Module(_TEXTS[module], vars(module)) for module in modules]


def _cvode_text() -> str:
    called = {name: of_declaration(*CVODE[name], name) for name in _CALLED}
    structures = {"SolverProblem": SolverProblem, "RunMemory": RunMemory, "Moments": Moments}
    outside = Outside(structures, _of_the_problem(), modules={"cvode": called})
    public = frozenset(("interval", "rhs", "weights", "jacobian", "state_at"))
    return write_program(_modules(_CVODE), outside, "solver_", public)


def _text(n: int, *, smooth: bool) -> str:
    """Return the text of one of our solvers: BDF for a number of states, or what stands in place of one."""
    if n == _SERIES:
        return _series_text()
    return _variable_text() if n == _VARIABLE else _own_text(n, smooth=smooth)


def _own_text(n: int, *, smooth: bool = False) -> str:
    """Write our solver, for n states only if that is not `_ANY`; all in one function takes LLVM 1 s more."""
    callbacks = {"evaluate": Evaluate, "weigh": Weigh, "fill": Fill}
    structures = {"SolverProblem": SolverProblem, "RunMemory": RunMemory, "Bdf": Bdf, "Moments": Moments}
    pointers = _of_the_problem() | {name: of_function(kind, "") for name, kind in callbacks.items()}
    direct = {name: name for name in callbacks}
    known = ({"n": n} if n else {}) | (NEVER_IN_SMOOTH_MODELS if smooth else {})
    outside = Outside(structures, pointers, direct, known)
    return write_program(_modules(_OWN), outside, "solver_", rare=_RARE)


def _series_text() -> str:
    structures = {
        "SolverProblem": SolverProblem, "RunMemory": RunMemory, "Taylor": Taylor, "Watch": Watch,
        "Moments": Moments,
    }  # fmt: skip
    kinds = {"expand": Expand, "modes": Compute, "place": Place, "share": Share}
    pointers = _of_the_problem() | {name: of_function(kind, "") for name, kind in kinds.items()}
    public = frozenset(("interval", "state_at", "scan_block", "move_block"))
    return write_program(
        _modules(_TAYLOR), Outside(structures, pointers, {"expand": "expand"}), "solver_", public
    )


def _variable_text() -> str:
    structures = {
        "SolverProblem": SolverProblem, "RunMemory": RunMemory, "Explicit": Explicit, "Moments": Moments,
    }  # fmt: skip
    pointers = _of_the_problem() | {"evaluate": of_function(Evaluate, "")}
    public = frozenset(("interval", "state_at"))
    outside = Outside(structures, pointers, {"evaluate": "evaluate"})
    return write_program(_modules(_EXPLICIT), outside, "solver_", public)


def _of_the_problem() -> dict[str, Signature]:
    return {name: of_declaration(*kinds, "") for name, kinds in FUNCTIONS.items()}


def _found(code: MachineCode, *, own: bool) -> StiffFunctions:
    rhs, weights, jacobian = (
        0 if own else code.address(f"solver_{name}") for name in ("rhs", "weights", "jacobian")
    )
    interval, state_at = code.address("solver_interval"), code.address("solver_state_at")
    return StiffFunctions(interval, rhs, weights, jacobian, state_at, code)
