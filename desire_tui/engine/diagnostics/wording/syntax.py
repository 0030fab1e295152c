"""Messages of the syntax stage."""

from __future__ import annotations

from desire_tui.engine.diagnostics.wording.entry import Wording

MESSAGES: dict[str, Wording] = {
    "not-a-statement": Wording(1, "'{first}' does not begin a statement", "assign a value with =, or begin with a keyword"),
    "number-format": Wording(6, "'{text}' is not a number", "numbers look like 12, .85, 1.2E-07"),
    "parenthesis-unclosed": Wording(7, "a parenthesis is not closed", "add )"),
    "parenthesis-stray": Wording(7, "a closing parenthesis without its opening one", "remove ) or add ("),
    "then-missing": Wording(10, "'then' is missing behind the condition", "write: if a > b then"),
    "relation-expected": Wording(10, "a relation is expected here", "compare with = < > <= >= or <>"),
    "relation-misplaced": Wording(10, "a relation cannot be part of an expression", "relations stand in if, while and until only"),
    "variable-missing": Wording(14, "a name is missing here", ""),
    "operand-missing": Wording(14, "a value is missing here", "an operator needs something on both sides"),
    "to-expected": Wording(23, "'to' is missing", "write: for i = 1 to 10 step 2"),
    "step-expected": Wording(23, "only 'step' may follow here", "write: for i = 1 to 10 step 2"),
    "bracket-unclosed": Wording(25, "a bracket or a comma is missing", "add ] or ,"),
    "bracket-stray": Wording(25, "a closing bracket without its opening one", "remove it, or add ["),
    "quote-unclosed": Wording(26, "a string is not closed", "add {quote} at its end"),
    "equals-missing": Wording(29, "'=' is missing here", ""),
    "statement-end": Wording(33, "the statement should end before '{text}'", "separate statements with | or begin a new line"),
    "strange-character": Wording(33, "the character '{char}' means nothing here", "remove it, or put text into quotes"),
    "octal-digits": Wording(57, "'{text}' is not an octal or hexadecimal number", "octal: &17, hexadecimal: &&F0"),
    "octal-too-large": Wording(57, "'{text}' does not fit into 16 bits", "the largest are &177777 and &&FFFF"),
    "operator-missing": Wording(60, "an operator is missing before '{text}'", "write * for a product"),
    "nested-too-deep": Wording(400, "more than {limit} brackets are open", "use intermediate variables"),
    "expression-too-deep": Wording(401, "the expression has more than {limit} levels", "use intermediate variables"),
    "line-too-long": Wording(402, "a line has more than {limit} characters", "use several statements"),
}
