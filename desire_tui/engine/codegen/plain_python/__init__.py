"""Compiles functions written in a small part of Python, so that an algorithm has one readable text.

All native code that no model changes is written this way: `integration.bdf` (which also runs as it stands,
for the reference back end and in tests), and the callbacks and intervals of `codegen.stiff`.
`program.write_program` turns texts into LLVM IR. Known are:

    numbers (`int`, `float`, `bool`), pointers to them (`Reals`, `Ints` …), C structures with their fields
    =  +=  -=  *=  /=   if   while   for … in range(…)   break   continue   return   pass
    + - * /   a float ** a number   comparisons   and, or, not   conditional expressions
    abs, min, max, sqrt, `library.copy`, functions of `switching.mathematics`
    calls of each other, of C functions, of a structure's function pointers

Types of arguments and results come from annotations; a variable has the type of what it is set to first. An
annotation in an assignment says what an address points at. Everything else is refused by
`PlainPythonError`, which names construct and line. What is accepted computes what Python computes, but for
`fused`, and for what hardware does in place of raising an error: division by zero gives inf or nan, so do
functions outside their domain; whole numbers have 64 bits and count as doubles among floats; no index is
checked.
"""
