"""Makes the model-independent native routines of rules 9 … 16, once a process, some once a machine."""

from __future__ import annotations

import re
from collections import defaultdict
from ctypes import sizeof
from hashlib import blake2b
from importlib.resources import files
from threading import Lock
from typing import Any, NamedTuple

from llvmlite import ir

from desire_tui.engine.codegen.jit.compiler import (
    MachineCode,
    compile_and_keep,
    compile_text,
    kept_code,
    machine,
)
from desire_tui.engine.codegen.stiff.callbacks import add_callbacks
from desire_tui.engine.codegen.stiff.interval import add_gather, add_interval
from desire_tui.engine.codegen.stiff.plain_python import PlainPython
from desire_tui.engine.codegen.stiff.steppers import CvodeStepper, OwnStepper
from desire_tui.engine.integration.bdf import choice, coefficients, newton, start, step
from desire_tui.engine.integration.bdf.memory import Bdf
from desire_tui.engine.integration.problem import SolverProblem
from desire_tui.engine.integration.sundials.library import libraries
from desire_tui.engine.integration.sundials.signatures import address
from desire_tui.engine.runtime.run_memory import RunMemory
from desire_tui.engine.values import DT, T

_CALLED = (
    "CVode", "CVodeReInit", "CVodeSetInitStep", "CVodeSetStopTime", "CVodeGetLastStep",
    "CVodeGetNumErrTestFails", "CVodeGetNumStepSolveFails",
)  # fmt: skip
_SOURCES = (
    "codegen/stiff/plain_expressions.py", "codegen/stiff/plain_python.py", "codegen/stiff/steppers.py",
    "codegen/stiff/ir_builder.py",
    "codegen/stiff/callbacks.py", "codegen/stiff/interval.py", "codegen/stiff/solver_routines.py",
    "integration/bdf/choice.py", "integration/bdf/coefficients.py", "integration/bdf/memory.py",
    "integration/bdf/newton.py", "integration/bdf/start.py", "integration/bdf/step.py",
    "integration/problem.py", "runtime/run_memory.py",
)  # fmt: skip
"""All that the code depends on: kept code of other texts is not looked at."""
_BDF = (choice, coefficients, newton, start, step)
_TEXTS = {name: (files("desire_tui.engine") / name).read_bytes() for name in _SOURCES}
"""Read now, when the modules are: files may change under a process that lives for days."""

_ANY = 0
"""In place of a number of states: code for all."""
_FAST = 1
"""Level of optimisation of what goes with CVODE: level 2 gains nothing there."""
LARGE = 200
"""More states than this are worth 0.1 s of optimisation; fewer get quick code after 0.02 s."""


class StiffFunctions(NamedTuple):
    """Addresses, 0 for what is not there; `keep` owns the code."""

    rhs: int
    weights: int
    jacobian: int
    interval: int
    """Of CVODE …"""
    own_interval: int
    """… and of `integration.bdf`."""
    keep: Any


class SolverRoutines:
    """Made when they are wanted, then kept."""

    def __init__(self) -> None:
        self._connected = False
        self._cvode: dict[int, StiffFunctions] = {}
        """By level of optimisation."""
        self._own: dict[int, StiffFunctions] = {}
        """By number of states."""
        self._locks = defaultdict[int, Lock](Lock)
        """By level: several sessions may ask for the same, and quick code does not wait for fast code."""

    def first(self, n: int, *, own: bool) -> StiffFunctions:
        """Return what a run can start with at once: fast code if there is some, else quick code."""
        if not own:
            return self._with_cvode(_FAST if n > LARGE else 0)
        # Writing our solver as IR takes 0.1 s, which every program with one run would pay
        return self._kept(n) or self._kept(_ANY) or self._make_own(_ANY, level=0)

    def fast(self, n: int, *, own: bool) -> StiffFunctions:
        """Compile the fastest code for n states (0.1 s; our solver, for just this n, 1 s once a machine)."""
        if not own:
            return self._with_cvode(_FAST)
        return self._kept(n) or self._make_own(n, level=2)

    def _with_cvode(self, level: int) -> StiffFunctions:
        self._connect()
        with self._locks[level]:
            if level not in self._cvode:
                self._cvode[level] = _found(compile_text(str(_module(own=False)), level=level), own=False)
            return self._cvode[level]

    def _make_own(self, n: int, *, level: int) -> StiffFunctions:
        """Compile our solver for n states, `_ANY` number of them."""
        self._connect()
        with self._locks[level]:
            if n not in self._own:
                text = str(_module(own=True, n=n))
                code = compile_and_keep(text, _name(n), level=level, vectorize=level > 0)
                self._own[n] = _found(code, own=True)
            return self._own[n]

    def _kept(self, n: int) -> StiffFunctions | None:
        """Return our solver's fast code for n states if this process or another one has made it."""
        if n not in self._own:
            self._connect()
            code = kept_code(_name(n))
            if code is None:
                return None
            self._own.setdefault(n, _found(code, own=True))
        return self._own[n]

    def _connect(self) -> None:
        """Tell LLVM where CVODE's functions are. DesireError 460, 461: no SUNDIALS."""
        if self._connected:
            return
        cvode = libraries().cvode
        llvm = machine().llvm
        for name in _CALLED:
            llvm.add_symbol(name, address(cvode, name))
        self._connected = True


def _name(n: int) -> str:
    layouts = repr(
        [T, DT, *((kind, sizeof(kind), kind._fields_) for kind in (Bdf, SolverProblem, RunMemory))]
    )
    everything = b"".join(_TEXTS.values()) + re.sub(" at 0x[0-9a-f]+", "", layouts).encode()
    return f"bdf-{n}-{blake2b(everything, digest_size=8).hexdigest()}"


def _module(*, own: bool, n: int = _ANY) -> ir.Module:
    """Write callbacks and interval loops; `own`: with our solver, for n states only if that is not `_ANY`."""
    module = ir.Module("stiff")
    add_callbacks(module)
    add_gather(module)
    add_interval(module, CvodeStepper())
    if own:
        natives = {name: module.globals[f"desire_{name}"] for name in ("evaluate", "weigh", "fill")}
        known = {"n": n} if n else {}
        sources = {_TEXTS[f"integration/bdf/{m.__name__.rpartition('.')[2]}.py"]: vars(m) for m in _BDF}
        own_solver = PlainPython(module, sources, Bdf, "bdf_", natives, known)
        add_interval(module, OwnStepper(own_solver.functions))
    return module


def _found(code: MachineCode, *, own: bool) -> StiffFunctions:
    return StiffFunctions(
        rhs=code.address("desire_rhs"),
        weights=code.address("desire_weights"),
        jacobian=code.address("desire_jacobian"),
        interval=code.address("cvode_interval"),
        own_interval=code.address("own_interval") if own else 0,
        keep=code,
    )
