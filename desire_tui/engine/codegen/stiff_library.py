"""Makes the model-independent native functions of rules 9 … 16, once a process."""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

from llvmlite import ir

from desire_tui.engine.codegen.compiler import compile_text, machine
from desire_tui.engine.codegen.stiff_callbacks import add_callbacks
from desire_tui.engine.codegen.stiff_interval import add_interval
from desire_tui.engine.integration.sundials.library import libraries
from desire_tui.engine.integration.sundials.signatures import address

_CALLED = (
    "CVode", "CVodeReInit", "CVodeSetInitStep", "CVodeSetStopTime", "CVodeGetLastStep",
    "CVodeGetNumErrTestFails", "CVodeGetNumNonlinSolvConvFails",
)  # fmt: skip


class StiffFunctions(NamedTuple):
    """Addresses; `keep` owns the code."""

    rhs: int
    weights: int
    jacobian: int
    interval: int
    keep: Any


LARGE = 200
"""More states than this are worth 0.1 s of optimisation; fewer get quick code after 0.02 s."""


@cache
def stiff_functions(*, large: bool) -> StiffFunctions:
    """Compile callbacks and interval loop. DesireError 460, 461: no SUNDIALS."""
    cvode = libraries().cvode
    llvm = machine().llvm
    for name in _CALLED:
        llvm.add_symbol(name, address(cvode, name))
    module = ir.Module("stiff")
    add_callbacks(module)
    add_interval(module)
    code = compile_text(str(module), level=1 if large else 0)  # level 2 gains nothing here
    rhs, weights, jacobian, interval = (
        code.address(f"desire_{name}") for name in ("rhs", "weights", "jacobian", "interval")
    )
    return StiffFunctions(rhs, weights, jacobian, interval, keep=code)
