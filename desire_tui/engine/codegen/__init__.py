"""Lowered segments as native code.

`NativeBackend().model(segment, rule, values)` gives a `runtime.backend.Model`. What back ends share, the code
and the threads that compile it, is one `compiler_state`. The rooms, from text to machine code:

    `ir`      LLVM IR as strings: a function's text as it grows, lanes, cells, the library as instructions
    `scalar`  statements and expressions over numbers
    `vector`  statements over arrays: loops over strips of elements, neighbours of one length fused
    `jit`     LLVM: texts compiled, kept by their digests; quick code first, fast code from `background`,
              bitwise the same results; what was compiled is on disk (`stored_code`), and is put into memory
              without LLVM (`object_file`, `placed_code`)
    `threads` loops of large models on all cores
    `exact_functions` sin, exp and the like for many numbers at a time, with the C library's bits
    `pieces`  a pass (`passes.slices`) as functions of some dozen statements in tables of addresses; loops
              that an edit changes keep their code and are called with other data
    `loop`    the run loop of language.md 8.2, written once over a `storage`, its steps fixed or variable:
              `register_storage` small models of scalars: states, parameters and passes in one function
              `array_storage`    all others: tables of pieces, one loop for all models of a rule
    `lanes`   many runs in lock step, a lane of vector code for each: the passes and the loop once more
    `stiff`   rules 9 … 16: CVODE's callbacks and interval loop as native functions
    `taylor`  rule 17: recurrences of Taylor coefficients, driven by `stiff`
    `equations` right-hand side and Jacobian as C functions of t and x, for other people's solvers
    `moments` models with events or delays: `runtime.moments` in the place of a step
    `plain_python` compiles readable Python to IR: `integration.bdf`, most of `stiff`, the learning rules

All IR is text. Code that belongs to a model, its helper functions and run loop included, is written through
`ir.text`; native code that no model changes is a text in plain Python.

Loops that others drive (rules 9 … 16) take the passes as C functions:

    functions = PassFunctions(compiler.code, values, segment.order, passes_of(segment))
    functions.address("derivative")   # int64 f(RunMemory *memory, double *k), see `pieces/pass_functions`

with the names `derivative`, `step`, `full`, `tail`, or any others with statements of their own (tangents,
JACOBIAN).
"""
