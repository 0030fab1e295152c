"""Messages of the syntax stage: statements that do not follow the grammar, blocks that do not match."""

from __future__ import annotations

from desire_tui.engine.data_classes import replace
from desire_tui.engine.diagnostics.wording.entry import Wording

_FOR = "write: for i = 1 to 10 step 2"
_DISPLAY = "display takes 0, 1, 2, a letter (A B C F N Q R W Y) or fit, logx, logy, loglog, linear, equal"

_SENTENCES: dict[str, Wording] = {
    # ------------------------------------------------------------------ one statement
    "not-a-statement": Wording(
        1, "'{first}' begins no statement", "assign it with =, or begin with a keyword"
    ),
    "expression-alone": Wording(1, "an expression is no statement", "assign it: y = …, or print it: write …"),
    "derivative-form": Wording(1, "this is no derivative", "write: d/dt x = …"),
    "derivative-spelling": Wording(
        1, "the book writes a derivative with d/dt alone", "write: {form} = …", warning=True
    ),
    "second-derivative": Wording(
        1, "a second derivative needs a state of its own", "write: d/dt x = v | d/dt v = …"
    ),
    "comment-mark": Wording(1, "this begins no statement", "a comment begins with --"),
    "foreign-end": Wording(
        33, "the statement should end before '{text}'", "separate statements by |, begin a comment with --"
    ),
    "power-spelling": Wording(14, "a power is not written like this", "write x^2"),
    "logical-spelling": Wording(10, "'{text}' is no operator", "write and, or, not"),
    "assignment-spelling": Wording(33, "'{text}' is no assignment", "write ="),
    "number-too-large": Wording(3, "the number is too large", "the largest is about 1.79E+308"),
    "number-format": Wording(6, "'{text}' is not a number", "numbers look like 12, .85, 1.2E-07"),
    "parenthesis-unclosed": Wording(7, "a parenthesis is not closed", "add )"),
    "parenthesis-stray": Wording(7, "')' closes no parenthesis", "remove it, or add ( before"),
    "then-missing": Wording(10, "'then' is missing behind the condition", "write: if a > b then"),
    "relation-expected": Wording(10, "a relation is expected here", "compare with = < > <= >= or <>"),
    "relation-misplaced": Wording(
        10, "a relation that is a value stands in parentheses", "write it so: (a > b) is 1 or 0"
    ),
    "relation-spelling": Wording(10, "'{text}' is not a relation", "write {right}"),
    "connect-form": Wording(11, "this is not how a file is connected", "write: connect 'name' as input 3"),
    "variable-missing": Wording(14, "a name is missing{before}", "a variable or array must stand here"),
    "operand-missing": Wording(
        14, "a value is missing{before}", "a number, a name or an expression must stand here"
    ),
    "target-illegal": Wording(
        14, "this cannot be assigned", "before = stands a name, or an element such as x[3]"
    ),
    "request-expression": Wording(14, "a request lists names only", "assign the expression to a name first"),
    "display-mode": Wording(14, "display has no such mode", _DISPLAY),
    "display-form": Wording(14, "display {mode} takes {wanted}", "write for instance: display N 14"),
    "to-expected": Wording(23, "'to' is missing{before}", _FOR),
    "step-expected": Wording(23, "only 'step' may follow here", _FOR),
    "bracket-unclosed": Wording(25, "a bracket or a comma is missing{before}", "add {closer} or ,"),
    "bracket-stray": Wording(25, "'{text}' closes no bracket", "remove it, or add its partner before"),
    "array-parenthesis": Wording(25, "dimensions stand in brackets", "write: ARRAY x[3]"),
    "dimensions-missing": Wording(25, "an ARRAY needs its dimensions", "write: ARRAY x[3], A[2, 2]"),
    "pair-form": Wording(25, "a complex number needs a comma", "write: [real, imaginary]"),
    "track-hold-form": Wording(25, "trkhld needs two variables and two values", "write: trkhld y, y0 = p, x"),
    "quote-unclosed": Wording(26, "a string is not closed", "add {quote} at its end"),
    "equals-missing": Wording(29, "'=' is missing{before}", "write: {form}"),
    "dimensions-too-many": Wording(32, "an array has at most {limit} dimensions", "use fewer subscripts"),
    "statement-end": Wording(33, "the statement should end before '{text}'", "separate statements by |"),
    "statement-cut": Wording(33, "the statement is not complete: '{wanted}' is missing", "add what follows"),
    "continuation-missing": Wording(
        33, "no row follows that the '_' could join", "remove it, or add the rest of the line", warning=True
    ),
    "strange-character": Wording(
        33, "the character '{char}' means nothing here", "remove it, or quote the text"
    ),
    "colon": Wording(33, "the character ':' means nothing here", "separate statements by |"),
    "file-name": Wording(34, "a file name in quotes is missing{before}", "write: connect 'name' as input 3"),
    "plot-form": Wording(36, "plot takes a point and a colour", "write: plot x, y, c"),
    "definition-form": Wording(37, "{word} is not written like this", "write: {word} name(a, b)"),
    "loop-variable-missing": Wording(48, "a loop needs a variable{before}", _FOR),
    "octal-digits": Wording(57, "'{text}' is neither octal nor hexadecimal", "octal: &17; hexadecimal: &&F0"),
    "octal-too-large": Wording(
        57, "'{text}' does not fit into 16 bits", "the largest are &177777 and &&FFFF"
    ),
    "overlay-nameless": Wording(
        29, "arrays joined by + need a name for the whole", "write: ARRAY a[n] + b[m] = ab"
    ),
    "argument-bare": Wording(
        60, "'{name}' is a function: its arguments stand in parentheses", "write {name}(…)"
    ),
    "operator-missing": Wording(60, "an operator is missing before '{text}'", "a product is written with *"),
    "fft-form": Wording(
        61, "FFT is not written like this", "write: FFT F, n, x, y (or I, C; R with x, y, u, v)"
    ),
    "only-comment": Wording(62, "only a comment may follow '{first}'", "separate statements by |"),
    "matrix-function": Wording(
        200, "there is no function '${matrix}' of this form", "$In(A) inverts a matrix, $Tr(A) transposes it"
    ),
    "go-where": Wording(62, "only a comment may follow 'go'", "a jump is written: go to {text}"),
    "label-expected": Wording(79, "a label is missing behind '{word}'", "write: {word} name"),
    "lines-form": Wording(62, "lines of the program are not named like this", "write: {word} 210-240, 260"),
    "delay-form": Wording(
        33, "{word} is not written like this", "write: {word} y = D(x, tau), or: {word} y = D, x, tau"
    ),
    "table-form": Wording(
        33,
        "{word} is not written like this",
        "write: func y = F(x), or: func y = F, x; func2 y = F(x1, x2; X, Y)",
    ),
    "learn-form": Wording(
        33,
        "{word} is not written like this",
        "write: CLEARN y = W(x) lrate, crit, PLEARN y = W*x; lrate, INTP y = W*x; thresh",
    ),
    "bounds-form": Wording(33, "two bounds stand behind the semicolon", "write: …; least, greatest"),
    "show-form": Wording(
        112, "SHOW is not written like this", "write: SHOW A, SHOW A, columns, SHOW or SHOW *"
    ),
    "element-illegal": Wording(209, "{first} assigns a whole array", "leave the subscripts out"),
    "nested-too-deep": Wording(400, "more than {limit} brackets are open", "use intermediate variables"),
    "expression-too-deep": Wording(
        401, "the expression has more than {limit} levels", "use intermediate variables"
    ),
    "line-too-long": Wording(403, "the line has more than {limit} characters", "use several statements"),
    # ------------------------------------------------------------------ blocks, labels, definitions
    "stray-end": Wording(4, "'end' closes nothing", "a loop ends with next, end while or until"),
    "if-without-then": Wording(
        10, "'then' is missing: in a script, if asks a question", "write: if a > b then"
    ),
    "unclosed-block": Wording(24, "'{word}' is not closed", "add '{closer}' where the block ends"),
    "stray-closer": Wording(27, "'{word}' closes nothing", "remove it, or open the block before it"),
    "defined-twice": Wording(55, "'{name}' is already defined", "choose another name"),
    "first-definition": Wording(55, "the first definition is here"),
    "unclosed-definition": Wording(58, "'{word}' has no 'end'", "add 'end' behind its last statement"),
    "no-such-label": Wording(68, "there is no label '{name}' in the script", "set one with: label NAME"),
    "label-twice": Wording(79, "the label '{name}' is set twice", "choose another name"),
    "segment-label-twice": Wording(
        79, "this segment never runs: '{name}' labels an earlier one", "choose another name", warning=True
    ),
    "segment-label-in-script": Wording(
        79,
        "'{name}' labels this segment and a place in the script",
        "drun {name} runs the segment, go to {name} jumps: two names would be clearer",
        warning=True,
    ),
    "first-label": Wording(79, "the first one is here"),
    "jump-inside": Wording(82, "'go to {name}' would jump into a block", "jump to its beginning instead"),
    "jump-out": Wording(82, "'go to {name}' would jump out of a PROCEDURE", "exit returns to the call"),
    "block-begins": Wording(82, "the block begins here"),
    "nested-definition": Wording(
        88, "'{name}' is defined inside another block", "move the definition out of it"
    ),
    "exit-nowhere": Wording(98, "'exit' stands in no loop and no PROCEDURE", "remove it"),
    "jump-to-segment": Wording(102, "'{name}' labels a DYNAMIC segment", "run it with: drun {name}"),
    "stray-else": Wording(111, "'{word}' belongs to no 'if'", "remove it, or add the if before it"),
    "second-else": Wording(111, "this 'if' has an 'else' already", "nested ifs need a proceed each"),
    "first-else": Wording(111, "the first one is here"),
    "end-if-in-script": Wording(111, "in a script, 'proceed' ends an if", "write proceed"),
    "dummy-twice": Wording(196, "the dummy argument '{name}' stands twice", "give each its own name"),
    "then-in-segment": Wording(
        219, "in a DYNAMIC segment, if takes a value, no 'then'", "for a > b write: if a - b"
    ),
    "call-missing": Wording(
        300,
        "'{name}(…)' is no statement of a script",
        "call a PROCEDURE: call {name}(…); use a function: y = {name}(…)",
    ),
}

_EXPLANATIONS = {
    "not-a-statement": """
        Every statement begins with a keyword or with the name that it assigns. Case matters: `drun` is a
        keyword, `Drun` is not. In a program an expression alone does nothing; on the command line it is
        printed.
    """,
    "number-format": """
        Numbers are written `12`, `.85`, `0.5`, `1.2E-07`. An exponent needs its digits, and there is one
        decimal point. Names begin with a letter: `x2`, not `2x`.
    """,
    "then-missing": """
        In a script `if` asks a question: `if a > b then`. Its statements follow, on the same line behind
        `|` or on lines of their own, up to `proceed`; `else` may stand between. In a DYNAMIC segment `if`
        has no `then`: `if e` lets the rest of the segment execute only while e > 0.
    """,
    "relation-expected": """
        A condition is a relation `= < > <= >= <>` between two expressions, or several of them joined by
        `and`, `or`, `not` and parentheses. A number is no condition: write `x <> 0`.
    """,
    "relation-misplaced": """
        In parentheses a condition is 1 where it holds and 0 where not: `y = (t > 0.5)*x`,
        `(t > 1 and t < 2)`. The book's functions say the same: `swtch(a - b)` is 1 if a > b, else 0, and
        `comp(a - b, minus, plus)` chooses between two values.
    """,
    "operand-missing": """
        An operator, a bracket or a keyword needs a value behind it. A line that ends with `+ - * / ^ =`
        or `_` goes on in the next one; no other does.
    """,
    "bracket-unclosed": """
        Subscripts and dimensions stand in brackets: `A[2, 3]`; arguments in parentheses: `sin(x)`; index
        shifts in braces: `x{-1}`.
    """,
    "quote-unclosed": """
        A string begins and ends on one line, with the same quote. The other quote may stand inside:
        `"it's"`.
    """,
    "octal-digits": """
        `&17370` is octal, `&&FC2` hexadecimal. Both have 16 bits, and values above 32767 stand for
        negative numbers: `&&FFFF` is −1.
    """,
    "unclosed-block": """
        Each block has its own end: `for` … `next`, `while` … `end while`, `repeat` … `until`, `if` …
        `proceed`. Blocks nest but do not cross.
    """,
    "unclosed-definition": """
        A PROCEDURE or SUBMODEL is everything up to its `end`.
    """,
    "stray-closer": """
        Perhaps the block's first line was removed, or an inner block is closed twice.
    """,
    "stray-else": """
        `else` and `proceed` belong to the last `if … then` that is still open. In DYNAMIC segments `end
        if` closes an `if e`, and `else` turns it.
    """,
    "jump-inside": """
        Jumps out of blocks, and within one, are fine. A jump into a loop would enter it without its first
        line; jump to a label before the block.
    """,
    "jump-out": """
        A PROCEDURE returns to the statement behind its call, by `end` or `exit`. Let it set a variable that
        the script tests behind the call, and jump from there.
    """,
    "nested-definition": """
        PROCEDUREs and SUBMODELs are defined side by side, outside of loops and ifs. They may call each
        other. A FUNCTION stands outside of them: it sees the program's names and its own dummies only.
    """,
    "request-expression": """
        `dispt`, `dispxy`, `DISPXY`, `type` and `stash` name variables or single elements. To show an
        expression, assign it to a variable above: `y2 = 2*y - 1`.
    """,
    "element-illegal": """
        Vector and matrix statements assign whole arrays. One element is assigned without the keyword:
        `x[2] = 3`, `d/dt x[2] = 3`.
    """,
    "fft-form": """
        `FFT F, n, x, y` transforms x + jy, `FFT I, n, x, y` back; `FFT R, n, x, y, u, v` transforms two
        real arrays at once; `FFT C, n, x, y` convolves cyclically.
    """,
    "expression-too-deep": """
        Operations are nested this deeply: powers of powers, signs before signs, parentheses in parentheses.
        A sum or a product may have any number of terms. Assign parts of the expression to variables; the
        compiler makes no slower code of that.
    """,
}
"""What the help page of a message says beyond sentence and hint."""

MESSAGES: dict[str, Wording] = {
    key: replace(wording, explanation=" ".join(_EXPLANATIONS.get(key, "").split()))
    for key, wording in _SENTENCES.items()
}
