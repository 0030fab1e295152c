"""Makes the model-independent native functions of rules 9 … 16, once a process."""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

from llvmlite import binding, ir

from desire_tui.engine.codegen.stiff_callbacks import add_callbacks
from desire_tui.engine.codegen.stiff_interval import add_interval
from desire_tui.engine.integration.sundials.library import libraries
from desire_tui.engine.integration.sundials.signatures import address

_CALLED = (
    "CVode", "CVodeReInit", "CVodeSetInitStep", "CVodeSetStopTime", "CVodeGetLastStep", "CVodeGetNumErrTestFails",
    "CVodeGetNumNonlinSolvConvFails",
)  # fmt: skip


class StiffFunctions(NamedTuple):
    """Addresses; `keep` owns the code."""

    rhs: int
    weights: int
    jacobian: int
    interval: int
    keep: Any


@cache
def stiff_functions() -> StiffFunctions:
    """Compile callbacks and interval loop. DesireError 460, 461: SUNDIALS cannot be used here."""
    cvode = libraries().cvode
    binding.initialize_native_target()
    binding.initialize_native_asmprinter()
    for name in _CALLED:
        binding.add_symbol(name, address(cvode, name))
    module = ir.Module("stiff")
    add_callbacks(module)
    add_interval(module)
    machine = binding.Target.from_default_triple().create_target_machine(
        cpu=binding.get_host_cpu_name(), features=binding.get_host_cpu_features().flatten(), opt=1
    )
    parsed = binding.parse_assembly(str(module))
    parsed.verify()
    tuning = binding.create_pipeline_tuning_options(speed_level=1)  # level 2 costs 0.3 s and gains nothing
    here
    tuning.loop_vectorization = tuning.slp_vectorization = tuning.loop_unrolling = False
    passes = binding.create_pass_builder(machine, tuning)
    passes.getModulePassManager().run(parsed, passes)
    engine = binding.create_mcjit_compiler(parsed, machine)
    engine.finalize_object() found = [engine.get_function_address(f"desire_{n}") for n in ("rhs", "weights", "jacobian", "interval")]
    return StiffFunctions(*found, keep=engine)
