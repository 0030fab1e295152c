"""Lowered segments as native code (the only home of llvmlite).

`NativeBackend().model(segment, rule, values)` gives a `runtime.backend.Model`. From text to machine code:

    statements, vectors … → `text`: LLVM IR as strings      (`expressions`, `functions`, `draws`, `lanes`)
    a pass (`analysis.slices`) → `pieces` of 100 statements → `store` → `compiler` (llvmlite)
    `driver` over a `loopframe`, its steps `fixed` or `variable`: the run loop of language.md 8.2, written
    once over a `Storage`:
        `registers` small models of scalars: states, parameters and passes in one function
        `arrays`    all others: tables of compiled pieces, one loop for all models of a rule
    `model`: quick code first, fast code from `background`, bitwise the same results

Loops that others drive (rules 9 … 16) take the passes as C functions:

    functions = PassFunctions(backend.store, values, segment.order, passes_of(segment))
    functions.address("derivative")   # int64 f(RunMemory *memory, double *k), see `natives`

with the names `derivative`, `step`, `full`, `tail`, or any others with statements of their own (tangents,
JACOBIAN).
"""

from __future__ import annotations

from desire_tui.engine.codegen.backend import NativeBackend
from desire_tui.engine.codegen.model import passes_of
from desire_tui.engine.codegen.natives import PassFunctions

__all__ = ["NativeBackend", "PassFunctions", "passes_of"]
