"""The solver of rules 14 and 15 for systems of a few states: CVODE's method without CVODE's generality.

CVODE calls a function for each operation on vectors, which for 3 states takes several times as long as the
operation. This is the same algorithm (step for step: tests compare them) for dense matrices only, written in
plain Python of a kind that `codegen.plain_python` compiles together with the model's callbacks.

After Cohen and Hindmarsh, "CVODE, a stiff/nonstiff ODE solver in C" (Computers in Physics 10, 1996), and the
CVODE user guide's chapter "Mathematical considerations"; constants have CVODE's names in brackets.
CVODE is part of SUNDIALS, whose copyright notice and licence are in LICENSES/SUNDIALS.txt.
"""
