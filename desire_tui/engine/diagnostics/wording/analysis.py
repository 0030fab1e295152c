"""Messages of the analysis stage."""

from __future__ import annotations

from desire_tui.engine.diagnostics.wording.entry import Wording

_EXPAND = "the line belongs to a submodel or FUNCTION that is used here"
_DECLARE = "declare arrays in the script, before drun: ARRAY {name}[n]"
_INITIAL = "give it an initial value in the script, or move this line below line {line}"

MESSAGES: dict[str, Wording] = {
    # ------------------------------------------------------------------ names
    "undefined-in-segment": Wording(
        200,
        "undefined variable '{name}'",
        "assign it in the script before drun, or in the segment above this line",
        "A DYNAMIC segment may read what the script has assigned, and what an earlier line has.",
    ),
    "used-before-set": Wording(
        200,
        "'{name}' is used before line {line} defines it",
        _INITIAL,
        "Defined variables are **not sorted**: a pass goes through the lines as written. A name used above "
        "the line which assigns it (after `OUT`, `SAMPLE`, `step` or `if`, perhaps) keeps its value from pass"
        " to pass and needs an initial one.",
    ),
    "recursion-undeclared": Wording(
        200,
        "'{name}' is computed from itself, at each pass anew, and a derivative reads it",
        "give it a first value in the script if a difference equation is meant, or put it behind `step`",
        "A line such as `y = cos(y*x)` is not solved for y: each pass takes the y of the pass before, and"
        " a rule makes several passes in a step. What comes out depends on the rule and on DT.",
        warning=True,
    ),
    "undefined-subscript": Wording(
        200,
        "undefined variable '{name}' in a number that must be known now",
        "subscripts are worked out when the run starts: assign it in the script",
    ),
    "undefined-in-vector": Wording(
        70, "'{name}' in a vector expression is neither an array nor a defined variable", _DECLARE
    ),
    "array-as-number": Wording(69, "'{name}' is an array: subscripts are missing", "write {name}[i]"),
    "vector-as-number": Wording(
        75,
        "'{name}' is a whole vector, a number is expected here",
        "use Vector y =, or DOT for sums of products",
    ),
    "number-as-array": Wording(19, "'{name}' is a number, an array is expected here", _DECLARE),
    "array-not-declared": Wording(19, "'{name}' is not declared as an array", _DECLARE),
    "function-with-brackets": Wording(
        19, "'{name}' is a function, not an array", "a function's arguments stand in parentheses: {name}(x)"
    ),
    "subscript-count": Wording(
        69, "'{name}' has {count} subscript(s)", "write as many as its declaration has"
    ),
    "subscript-out-of-range": Wording(
        2, "subscript {number} of '{name}' is {value}, it may be 1 to {size}", "subscripts start at 1"
    ),
    "constant-not-computable": Wording(
        44,
        "this number must be known when the run starts, and cannot be worked out",
        "use numbers and script variables only",
    ),
    "complex-in-dynamic": Wording(
        218,
        "'{name}' is COMPLEX: only real quantities can be used in a DYNAMIC segment",
        "work with real and imaginary part",
    ),
    "not-real-target": Wording(
        218,
        "'{name}' is not a real quantity and cannot be assigned in a DYNAMIC segment",
        "use a variable that is not declared INTEGER or COMPLEX",
    ),
    "time-as-target": Wording(
        87,
        "t cannot be assigned where there are differential equations: the integration rule moves it",
        "use another name; set t in the script before drun, and end a run with `term`",
        "A step begins where the one before has ended: a segment that sets t at each pass may never reach"
        " TMAX. Segments without `d/dt` may set it: their passes are counted.",
    ),
    "constant-target": Wording(73, "'{name}' is a constant", "use another name"),
    "function-as-variable": Wording(73, "'{name}' is a FUNCTION and cannot be assigned", "use another name"),
    # ------------------------------------------------------------------ functions, submodels
    "expanded-here": Wording(0, "used here", _EXPAND),
    "unknown-function-in-dynamic": Wording(
        59, "unknown function '{name}'", "define it in the script: FUNCTION {name}(x$) = …"
    ),
    "script-function": Wording(
        59, "the function '{name}' can be used in scripts only", "compute its value before drun"
    ),
    "function-as-statement": Wording(
        219, "'{name}' is a function: its value is not used", "assign it: y = {name}(…)"
    ),
    "library-arguments": Wording(
        56, "{name}({parameters}) is called with {given} argument(s)", "write {name}({parameters})"
    ),
    "function-arguments": Wording(
        56, "FUNCTION '{name}' has {wanted} argument(s), not {given}", "give each dummy its argument"
    ),
    "function-recursion": Wording(
        52, "FUNCTION '{name}' would call itself", "use a loop or a difference equation"
    ),
    "functions-too-deep": Wording(
        52, "more than {limit} FUNCTIONs call one another", "put the bodies of some into those that call them"
    ),
    "too-many-expansions": Wording(
        410,
        "more than {most} FUNCTION calls would be expanded, '{name}' among them",
        "assign intermediate results to variables",
    ),
    "too-many-lines": Wording(
        411,
        "the segment would have more than {most} lines when '{name}' is expanded",
        "invoke fewer submodels, or use vectors",
    ),
    "undefined-submodel": Wording(
        201, "there is no submodel '{name}'", "declare it in the script: SUBMODEL {name}(…) … end"
    ),
    "moment-without-blank": Wording(
        201,
        "there is no submodel '{name}'",
        "write a blank behind the word if you mean the statement: {name} (…)",
    ),
    "submodel-arguments": Wording(
        56, "submodel '{name}' has {wanted} argument(s), not {given}", "give each dummy its argument"
    ),
    "submodel-recursion": Wording(
        52, "submodel '{name}' would invoke itself", "submodels may nest, not recurse"
    ),
    "submodels-too-deep": Wording(
        52, "more than {limit} submodels invoke one another", "invoke some of them in the segment itself"
    ),
    "ifs-too-deep": Wording(
        52, "more than {limit} of if, OUT, SAMPLE and step are open here", "join conditions: if min(a, b)"
    ),
    "submodel-argument-not-name": Wording(
        209, "an argument of submodel '{name}' must be a name", "assign the expression to a variable first"
    ),
    "table-not-a-name": Wording(36, "a table is given by the name of its array", "write func1(x; F)"),
    "table-size": Wording(
        32,
        "the table '{name}' has {size} element(s): breakpoints and as many values are needed",
        "declare: ARRAY X[n] + Y[n] = {name}",
    ),
    "table2-size": Wording(
        74, "func2 needs {f}[n,m] with breakpoints {x}[n] and {y}[m]", "make the declarations agree"
    ),
    # ------------------------------------------------------------------ vectors and matrices
    "shapes-disagree": Wording(
        74, "'{name}' has the shape {shape}, {wanted} is needed here", "sizes must agree element by element"
    ),
    "vector-recursion": Wording(
        85,
        "the target would be read after some of its elements are replaced",
        "compute it into another array first",
        "Elements are assigned from the last to the first. `Vector x = A * x` and `Vector x = x{1}` would "
        "use new values in place of old ones.",
    ),
    "matrix-needs-vector": Wording(
        75,
        "the matrix '{name}' must be followed by * and a vector",
        "write {name} * x; for all elements use MATRIX, or declare a vector view: ARRAY W[m,n] = v",
    ),
    "vector-in-matrix": Wording(
        75, "the vector '{name}' stands alone in a matrix expression", "vectors come in pairs: u*v or u & v"
    ),
    "vector-target": Wording(
        75, "'{name}' has {dimensions} dimensions, a vector is needed", "use MATRIX, or a view"
    ),
    "matrix-target": Wording(75, "'{name}' has {dimensions} dimension(s), a matrix is needed", "use Vector"),
    "states-target": Wording(
        75,
        "'{name}' has {dimensions} dimensions, a vector or a matrix of states is needed",
        "declare a view of it: STATE {name}[…] = v, and write Vectr d/dt v",
    ),
    "row-of-matrix": Wording(
        75,
        "'{name}#' takes a row: '{name}' must be a matrix, and the statement a Vector one",
        "declare {name}[m,n]",
    ),
    "shift-in-matrix": Wording(75, "index shifts are for vectors", "use Vector statements"),
    "ampersand-here": Wording(75, "& joins two vectors of a MATRIX expression: u & v", "use * for products"),
    "dot-term": Wording(
        75, "DOT adds products of names: u*v, u*1, u*A*v, u*A%*v", "assign expressions to a vector first"
    ),
    "average-lengths": Wording(74, "AVG divides by the length: all vectors must be equally long", "use DOT"),
    "history-not-vector": Wording(75, "'{name}' must have one dimension", "declare: ARRAY {name}[n]"),
    # ------------------------------------------------------------------ statements
    "illegal-in-dynamic": Wording(
        219, "'{word}' cannot be used in a DYNAMIC segment", "move it to the script, above DYNAMIC"
    ),
    "state-twice": Wording(101, "'{name}' has two derivatives", "remove one d/dt line"),
    "state-twice-overlaid": Wording(
        101,
        "a state of '{name}' has two derivatives: it has one through '{other}' already",
        "the two arrays share storage; remove one d/dt line",
    ),
    "second-request": Wording(
        8, "a second {kind}: the segment has one in line {line}", "join the lists, or use another segment"
    ),
    "noise-under-rule": Wording(
        489,
        "a derivative depends on this random number, drawn anew at each stage: not under rule {rule}",
        "draw it behind `step`, SAMPLE or `every`, or use white(…) with irule 2, 1 or 3",
    ),
    "white-under-rule": Wording(
        488,
        "white noise cannot be integrated by rule {rule}, which tests its steps",
        "use irule 2 (Euler-Maruyama), 1 (Heun) or 3, with a DT that is small enough",
        "A step that fails is tried again with half of DT, where the noise would be another: no step is ever"
        " small enough.",
    ),
    "white-without-states": Wording(
        488, "white() needs a differential equation: its size depends on DT", "use gauss() between points"
    ),
    "delay-of-product": Wording(
        75,
        "delay(x, tau) cannot look into this product of arrays",
        "assign the product to an array in a line of its own, and delay that",
    ),
    "delay-without-states": Wording(
        484, "delay(x, tau) needs a differential equation", "use the statement delay y = D(x, tau)"
    ),
    "stray-end-event": Wording(4, "there is no `event` or `every` for this `end event`", "remove it"),
    "moment-in-if": Wording(
        219, "`{word}` cannot stand behind `if`", "write `end if` before it, and the condition into its block"
    ),
    "if-open-at-moment": Wording(
        219,
        "an `if` in the block of `event` or `every` above is still open here",
        "write `end if` before this",
    ),
    "not-at-moment": Wording(
        219,
        "'{word}' cannot be executed at a moment",
        "write `end event` before it, or move it above the block",
        "The lines behind `event` and `every`, up to the next `event`, `every`, `OUT`, `SAMPLE`, `step` or"
        " `end event`, are executed once each time: they set states and other numbers.",
    ),
    "second-sample": Wording(8, "a second SAMPLE", "one SAMPLE in a segment"),
    "sample-below-one": Wording(
        44, "SAMPLE {value}: at least 1 is needed", "SAMPLE m runs at every m-th point"
    ),
    "pairs-expected": Wording(
        14, "DISPXY needs pairs of names: x1, y1, x2, y2 and so on", "add or remove a name"
    ),
    "abscissa-and-ordinate": Wording(14, "dispxy needs an abscissa and a curve", "write dispxy x, y"),
    "array-in-request": Wording(
        69, "'{name}' is an array: one of its elements can be shown", "write {name}[i], or SHOW {name}"
    ),
    "measured-not-sampled": Wording(
        536,
        "'{name}' is a column of a data file, and '{kind}' takes samples of the run",
        "dispt draws its points; its value at any time is func1(t; {name})",
    ),
    "times-in-request": Wording(
        536,
        "'{name}' holds the times of {file}: the other columns are drawn over them, and it has no table",
        "leave it out, or name another column",
    ),
    "measured-over-quantity": Wording(
        536,
        "'{name}' is a column of a data file, '{other}' is not: they have values at other times",
        "draw one column over another (DISPXY x, y, column1, column2), or all over t (dispt)",
    ),
    "show-array": Wording(112, "SHOW needs an array, '{name}' is none", "declare it: ARRAY {name}[m,n]"),
    "show-columns": Wording(112, "SHOW with {value} columns", "at least one column"),
    "illegal-in-jacobian": Wording(
        219, "behind JACOBIAN only assignments may stand", "write J[i,k] = …, and helper variables"
    ),
    "second-jacobian": Wording(
        230, "'{name}' is a second matrix: the JACOBIAN is '{first}'", "assign elements of one matrix"
    ),
    "jacobian-too-small": Wording(
        230, "'{name}' is too small for {order} state(s)", "declare: ARRAY {name}[{order},{order}]"
    ),
    "jacobian-entry": Wording(
        230,
        "this element is outside of the Jacobian of {order} state(s)",
        "rows and columns are numbered in the order of the d/dt lines",
    ),
}
