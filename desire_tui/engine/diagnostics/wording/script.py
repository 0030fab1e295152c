"""Messages of the script stage."""

from __future__ import annotations

from desire_tui.engine.diagnostics.wording.entry import Wording

MESSAGES: dict[str, Wording] = {
    # ------------------------------------------------------------------------------ names and values
    "undefined-variable": Wording(
        200,
        "undefined variable '{name}'",
        "assign it a value before this line",
        "Every name gets its value from the script, or from a run that sets it. Only on its own "
        "right side does a "
        "new name count as 0, so that `n = n + 1` may begin to count.",
    ),
    "undefined-function": Wording(
        200, "there is no function '{name}'", "an array needs square brackets: {name}[…]"
    ),
    "segment-function": Wording(
        59, "the function '{name}' can be used in DYNAMIC segments only", "use it behind DYNAMIC"
    ),
    "function-without-arguments": Wording(
        200, "'{name}' is a function and needs its arguments here", "write {name}(…)"
    ),
    "undefined-procedure": Wording(
        201, "there is no PROCEDURE '{name}' in the program", "declare it: PROCEDURE {name}(…) … end"
    ),
    "constant-assigned": Wording(55, "'{name}' is a constant", "choose another name"),
    "name-of-something-else": Wording(73, "'{name}' is {what} already", "choose another name"),
    "script-subscript-out-of-range": Wording(
        2,
        "subscript {value} is not between 1 and {size}",
        "this is subscript number {place}",
        "Subscripts run from 1 to the dimension that the declaration gives. A subscript may be "
        "any real expression: "
        "it is checked first, then truncated.",
    ),
    "script-subscript-count": Wording(
        53, "'{name}' has {needed} subscript(s), not {given}", "give one for each dimension"
    ),
    "not-an-array": Wording(19, "'{name}' is not an array", "declare it first: ARRAY {name}[n]"),
    "array-without-subscripts": Wording(
        53,
        "'{name}' is an array; a single number is needed here",
        "choose an element: {example}",
        "Whole arrays stand in `Vector`, `MATRIX`, `DOT`, `FFT`, `read`, `input`, `write`, "
        "`func1`, and as arguments. "
        "Everywhere else one element is meant: `x[3]`.",
    ),
    "array-name-expected": Wording(
        19, "the name of a whole array is needed here", "write it without subscripts"
    ),
    # ------------------------------------------------------------------------------ arithmetic
    "division-by-zero": Wording(
        5,
        "division by zero",
        "test the divisor before this line",
        "In scripts a division by zero stops the program at once. In DYNAMIC segments it gives inf or"
        " nan: the run ends where a state, or what states are made of, shows it; other curves have a gap.",
    ),
    "overflow": Wording(
        3,
        "the result is too large for a number",
        "numbers end at about 1.8E+308",
        "A result beyond 1.8E+308 has no value. Often a loop does not converge, or a step DT is too large.",
    ),
    "integer-overflow": Wording(20, "{value} is too large for a whole number", "whole numbers end at 2^53"),
    "logarithm-argument": Wording(9, "{function} needs a positive number", "check its argument"),
    "root-of-negative": Wording(
        47, "square root of a negative number", "check the argument, or take sqrt(abs(x))"
    ),
    "power-argument": Wording(
        9,
        "a power that is no whole number needs a positive base",
        "whole powers are written as numbers: x^2",
        "`x^3` and `x^-2` are products and take any x. With an exponent that is a variable or a fraction, "
        "`x^a` is exp(a ln x), and x must be positive.",
    ),
    "argument-out-of-domain": Wording(
        44, "{function} has no value for this argument", "check how large its argument is"
    ),
    "argument-count": Wording(44, "'{name}' cannot take {given} argument(s)", "write {name}({needed})"),
    "arguments-do-not-match": Wording(
        56, "'{name}' has {needed} argument(s){where}, not {given}", "give one for each dummy argument"
    ),
    "table-shape": Wording(
        44,
        "'{name}' cannot be a function table",
        "a table has an even number of elements: breakpoints, then values",
    ),
    "table2-shape": Wording(
        44,
        "'{name}' does not fit its breakpoints",
        "{rows} and {columns} breakpoints need {name}[{rows},{columns}]",
    ),
    "script-function-recursion": Wording(52, "FUNCTION '{name}' uses itself", "write a loop instead"),
    "too-deep": Wording(52, "expressions are nested too deeply", "use intermediate variables"),
    # ------------------------------------------------------------------------------ kinds
    "complex-not-possible": Wording(
        84, "a COMPLEX value is not possible here", "take Re(z), Im(z), Cabs(z) or Arg(z)"
    ),
    "complex-to-real": Wording(
        84,
        "a COMPLEX value does not fit into the real '{name}'",
        "declare: COMPLEX {name}, or take Re(…)",
        "Conversion goes one way only: a real value may be assigned to a COMPLEX name.",
    ),
    "complex-not-ordered": Wording(
        84, "COMPLEX values cannot be compared with {operator}", "compare Cabs(z)"
    ),
    "complex-power": Wording(75, "a COMPLEX value can be raised to whole powers only", "write products: z*z"),
    "not-in-scalar-expression": Wording(
        209, "this belongs into vector and matrix statements", "use elements, or Vector, MATRIX, DOT"
    ),
    "matrix-operator": Wording(209, "'{operator}' belongs into MATRIX statements", "use min(x, y)"),
    # ------------------------------------------------------------------------------ declarations
    "declared-twice": Wording(
        28,
        "'{name}' is declared already, as {before}",
        "use clear, or choose another name",
        "A program that runs again starts with `clear`, or with `erun`, which clears. The same "
        "name with the same "
        "dimensions may be declared again: that fills it with zeroes.",
    ),
    "bad-dimension": Wording(
        32, "'{name}' cannot have {value} elements in a row", "dimensions are 1 or more"
    ),
    "array-too-large": Wording(
        40, "no room for {elements} elements of '{name}'", "this machine has room for about {room}"
    ),
    "system-variable-declared": Wording(73, "'{name}' is a system variable", "choose another name"),
    "overlay-not-real": Wording(202, "only real arrays can lie over each other", "declare them one by one"),
    # ------------------------------------------------------------------------------ control
    "step-is-zero": Wording(23, "the step is 0, so the loop would never end", "give a step that is not 0"),
    "loop-variable": Wording(48, "'{name}' cannot count a loop", "loop variables are real"),
    "reached-from-here": Wording(52, "reached from here"),
    "procedure-recursion": Wording(
        52,
        "PROCEDURE '{name}' is being executed already",
        "write a loop instead",
        "The dummy arguments of a PROCEDURE exist once, so it cannot be called again before it has returned.",
    ),
    "reference-expected": Wording(
        56, "behind the ; only names and elements can stand", "assign it to a variable first"
    ),
    "clear-in-procedure": Wording(
        22, "'clear' would take away the PROCEDURE's own arguments", "clear outside of it"
    ),
    "not-a-command": Wording(22, "'{word}' works in programs only", "put it into the program"),
    "command-only": Wording(199, "'{word}' is a command, not a statement", "type it at the prompt"),
    "not-in-script": Wording(
        300, "this statement belongs behind DYNAMIC", "scripts end where DYNAMIC stands"
    ),
    # ------------------------------------------------------------------------------ data, files, console
    "out-of-data": Wording(
        51,
        "no data left to read",
        "add items to a data line, or restore",
        "`read` takes the items of all `data` lines in the order they stand. `restore` goes back "
        "to the first, "
        "`restore label` to those behind a label.",
    ),
    "channel-number": Wording(50, "there is no channel {channel}", "channels are numbered from 0 to 10"),
    "channel-connected": Wording(
        30,
        "channel {channel} is connected already, to '{file}'",
        "disconnect {channel}, or take another channel",
    ),
    "channel-not-connected": Wording(
        63,
        "channel {channel} is not connected",
        "connect a file: connect 'name' as output {channel}",
        "A channel belongs to a file between `connect` and `disconnect`. Starting a program "
        "closes all channels.",
    ),
    "channel-wrong-way": Wording(
        64, "channel {channel} is connected for {mode}", "connect another one as {wanted}"
    ),
    "cannot-connect": Wording(11, "cannot connect '{file}': {reason}", "check the file's name and folder"),
    "data-file-not-found": Wording(38, "there is no file '{file}'", "names without an ending get .dat"),
    "file-name-missing": Wording(34, "a file name in quotes is needed", "connect 'name' as input 3"),
    "file-ended": Wording(18, "'{file}' has no more values", "count its values, or read fewer"),
    "rows-missing": Wording(
        18,
        "'{file}' has {rows} row(s) of values left, {needed} are wanted",
        "an array takes as many rows as it has elements: declare arrays of that size",
    ),
    "column-missing": Wording(
        18,
        "'{file}' has no column '{name}': its columns are {columns}",
        "give the quantities the names of the columns, or name as many as there are columns",
        "Where the first line of a file names its columns, `input #n, t, x` takes the columns `t` and `x`, a "
        "row into scalars, whole columns into arrays. A unit behind a name is left out: `T [K]` is `T`.",
    ),
    "columns-unequal": Wording(
        18,
        "'{name}' takes {size} row(s) and '{first}' {have}",
        "columns are read together: scalars alone, or arrays of one size",
    ),
    "cell-not-a-number": Wording(
        18,
        "line {line} of '{file}' has no number in column '{column}': '{entry}'",
        "correct the line, or begin it with # to leave it out",
    ),
    "data-name-taken": Wording(
        73,
        "the column {column} of {file} becomes the table {name}, but {name} is {what} already",
        "rename one of them: the column in the file's first line, or what the program calls so",
    ),
    "measurements-missing": Wording(
        38, "there is no file '{file}'", "its path begins at the program's folder; write its ending, too"
    ),
    "data-note": Wording(535, "{what}", warning=True),
    "cannot-read": Wording(18, "cannot read '{file}': {reason}", "check the file"),
    "cannot-write": Wording(106, "cannot write '{file}': {reason}", "is the disk full?"),
    "bad-entry": Wording(
        18, "'{entry}' from {origin} is no value: {reason}", "values are separated by commas, tabs, lines"
    ),
    "entry-not-a-value": Wording(
        18, "'{entry}' is no value", "enter a number or an expression, or ! to break off"
    ),
    "input-broken-off": Wording(197, "input broken off", "nothing was assigned by this entry"),
    "input-ended": Wording(18, "there is no more input", "an input statement waits for a value"),
    "character-code": Wording(44, "{value} is no character's number", "ordinary characters are 32 to 126"),
    # ------------------------------------------------------------------------------ arrays
    "nonconformable": Wording(
        74,
        "sizes do not fit: {have} and {want}",
        "check the arrays' dimensions",
        "In `A*x` the matrix has as many columns as the vector has elements; sums need equal dimensions.",
    ),
    "not-a-matrix": Wording(74, "'{name}' is not a matrix", "a matrix has two dimensions"),
    "not-a-vector": Wording(74, "'{name}' is not a vector", "a vector has one dimension"),
    "not-square": Wording(74, "only a square matrix has an inverse, not {have}", "check the dimensions"),
    "singular-matrix": Wording(123, "the matrix is singular: it has no inverse", "are its rows independent?"),
    "matrix-from-number": Wording(
        75, "a matrix cannot be set to this number", "= 0 gives zeroes, = 1 the identity"
    ),
    "not-in-array-expression": Wording(
        75, "rows A# of a matrix can be taken in DYNAMIC segments only", "use elements: A[i,k]"
    ),
    "takes-no-array": Wording(75, "'{name}' cannot take arrays", "use their elements: {name}(x[i])"),
    "script-dot-term": Wording(75, "a DOT term is u*v, u*1, u*A*v or u*A%*v", "operands are names"),
    "fft-array": Wording(61, "'{name}' is not a vector", "FFT works on one-dimensional arrays"),
    "fft-array-short": Wording(
        61, "'{name}' has {size} elements, fewer than {n}", "declare it at least that long"
    ),
    "fft-arrays-overlap": Wording(
        61, "'{name}' and '{other}' share elements", "give each part an array of its own"
    ),
    "fft-length": Wording(72, "a transform of length {n} is not possible", "the length is 2 or more"),
    # ------------------------------------------------------------------------------ devices
    "no-such-rule": Wording(86, "there is no integration rule {rule}", "rules are 0 … 5 and 7 … 17"),
    "plot-arguments": Wording(
        44, "plot takes x, y and a colour, or a COMPLEX z and a colour", "plot x, y, 14"
    ),
    "script-show-columns": Wording(
        112, "SHOW cannot make {columns} columns of {size} elements", "SHOW A, columns"
    ),
}
