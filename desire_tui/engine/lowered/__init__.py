"""A DYNAMIC segment ready for any back end: names are slots, everything is expanded, shapes are checked.

Made by `lowering`, run by `codegen` (native) and `reference` (NumPy). Two back ends that follow the words
below give the same numbers.

**Expressions** are values over one *extent*: a scalar, n elements of a vector, or rows × cols of a matrix
(row-major). Scalars broadcast. An expression object that occurs twice in a statement (a FUNCTION's
argument) is evaluated **once**: compare by identity; met again in another statement, it is evaluated there
anew. Operands are evaluated left to right, which fixes the order of random draws; vector and matrix elements
are assigned from the last index to the first, each drawing as it comes.

**Statements** run in order. `Guard` holds statements that run only at some passes (language.md 9.1); which
statements a pass with given flags executes is `passes.slices`. The states' own slots hold the states of
the present stage; a `Set` of a state moves it from there on. Derivatives always stand outside of guards:
under a guard lowering computes them into numbers of its own, and the derivative proper reads those at the
end of the pass, so that a derivative whose guard is shut keeps its last value.

**Loop.** Rule 0 moves t on by COMINT after the last sample too. inf and nan are looked for at communication
points, states first, then the columns that states depend on (`passes.vital_columns`); the row is not
written. The test difference of rules 4, 7, 8 is relative to |x| + 1 at the step's start; a difference that is
nan counts as small, and the states' nan ends the run.
"""
