"""Finds the plain words for a token that cannot stand where it stands.

The automaton knows which kinds of tokens could have stood there; the rules below are tried in order, from
what one statement alone can get wrong to what any can. Error numbers are Desire's (wording/syntax.py).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.library import LIBRARY
from desire_tui.engine.syntax.statement_tokens import (
    CLASSES,
    LETTER,
    NAME,
    NUMBER,
    OCTAL,
    STRING,
    TokenFault,
    comment_mark,
    shown,
)
from desire_tui.engine.syntax.words import CLOSERS, OPENERS, RELATIONS, keyword_like

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.syntax.statement_tokens import StatementTokens

_OPERANDS = frozenset({NAME, NUMBER, OCTAL, STRING})
_OPERAND_END = frozenset({NAME, NUMBER, OCTAL, STRING, LETTER, ")", "]", "}", "%"})
_ASSIGNING_FORMS = {
    "store": "store X = x",
    "get": "get x = X",
    "DOT": "DOT s = u*v",
    "d/dt": "d/dt x = expression",
}
_BEGINNINGS = frozenset(
    {"next", "else", "proceed", "drun", "drunr", "reset", "write", "STOP", "until", "exit"}
)
_REQUESTS = frozenset({"dispt", "dispxy", "DISPXY", "type", "stash", "recover"})
_DEFINITIONS = frozenset({"PROCEDURE", "SUBMODEL", "FUNCTION", "call", "invoke"})
_WHOLE_ARRAYS = frozenset({"Vector", "MATRIX", "DELTA", "Delta", "store"})
_LISTERS = frozenset({"edit", "ed", "list", "list+", "auto"})
_NEXT = ("=", "to", ")", "]", ",", "(")
"""What a statement that ends too early most likely lacks: the first of these that may follow."""
_LABELS = frozenset({"label", "go to", "restore"})


def explain(chunk: StatementTokens, at: int, expected: frozenset[str]) -> TokenFault:
    """Return the fault of a statement whose token number `at`, or its end, is none of the `expected`."""
    stuck = _Stuck(chunk, at, expected)
    for rule in _RULES:
        key = rule(stuck)
        if key:
            return TokenFault(key, stuck.start, stuck.end, stuck.facts)
    if stuck.ended:
        stuck.facts["wanted"] = next((kind for kind in _NEXT if kind in expected), "…")
        return TokenFault("statement-cut", stuck.start, stuck.end, stuck.facts)
    return TokenFault("statement-end", stuck.start, stuck.end, stuck.facts)


class _Stuck:
    """Where the automaton got stuck, in the words the rules use."""

    def __init__(self, chunk: StatementTokens, at: int, expected: frozenset[str]) -> None:
        self.kinds, self.texts, self.at, self.expected = chunk.kinds, chunk.texts, at, expected
        self.chunk = chunk
        self.ended = at >= len(chunk.kinds)
        self.kind = "" if self.ended else chunk.kinds[at]
        self.text = "" if self.ended else chunk.texts[at]
        self.previous = chunk.kinds[at - 1] if at else ""
        self.word = chunk.kinds[0]
        self.place(at)
        self.opened = _open_bracket(chunk.kinds[:at])
        self.after_operand = self.previous in _OPERAND_END
        self.wants_operand = NUMBER in expected
        self.facts: dict[str, object] = {
            "text": _bare(shown(self.text)), "word": self.word, "first": _bare(shown(chunk.texts[0])),
            "closer": {"(": ")", "{": "}"}.get(self.opened, "]"),
            "before": f" before {_quoted(shown(self.text))}" if self.text else "",
        }  # fmt: skip

    def place(self, first: int, last: int | None = None) -> None:
        """Point at tokens; past the last one, at the statement's end."""
        chunk = self.chunk
        if first >= len(chunk.kinds):
            self.start = chunk.ends[-1]
            self.end = self.start + 1
        else:
            self.start, self.end = chunk.starts[first], chunk.ends[first if last is None else last]


def _relation_spelling(s: _Stuck) -> str:
    """`=>`, `==`, `><`."""
    if s.kind in RELATIONS and s.previous in RELATIONS and s.wants_operand:
        s.place(s.at - 1, s.at)
        s.facts["text"] = f"{s.texts[s.at - 1]}{s.text}"
        s.facts["right"] = {"=>": ">=", "=<": "<=", "><": "<>", "==": "="}.get(f"{s.previous}{s.kind}", "<>")
        return "relation-spelling"
    return ""


def _brackets(s: _Stuck) -> str:
    too_many = s.kind in (",", ";") and s.after_operand and "," not in s.expected
    if s.opened == "(" and ")" in s.expected and (s.ended or too_many or s.kind in ("]", "}", "=")):
        s.facts["at"] = s.text
        return "parenthesis-unclosed"
    if s.kind == ")" and s.opened != "(":
        return "parenthesis-stray" if s.opened == "" else "bracket-unclosed"
    ends = s.ended or too_many or s.kind in (*CLOSERS, "=")
    if s.opened in ("[", "{") and ends and s.after_operand:
        return "bracket-unclosed"
    if s.kind in ("]", "}") and s.opened != OPENERS.get(s.kind, ""):
        return "bracket-stray"
    return ""


def _mixed_brackets(s: _Stuck) -> str:
    """`A[3) = 1`: a bracket of the other kind may close the list of a submodel only, as a statement."""
    if s.word != NAME or s.kinds[1:2] not in (["("], ["["]):
        return ""
    depth = 0
    for at, kind in enumerate(s.kinds[: s.at]):
        depth += (kind in OPENERS.values()) - (kind in CLOSERS)
        if kind in CLOSERS and depth == 0:
            if OPENERS.get(kind) == s.kinds[1]:
                return ""
            s.place(at)
            s.facts |= {
                "at": s.texts[at],
                "closer": {"(": ")", "[": "]"}[s.kinds[1]],
                "before": f" before '{kind}'",
            }
            return "parenthesis-unclosed" if s.kinds[1] == "(" else "bracket-unclosed"
    return ""


def _own_form(s: _Stuck) -> str:
    """Faults that only one statement can have."""
    word = s.word
    if word == "if" and "then" in s.expected and s.after_operand and (s.ended or s.kind in CLASSES):
        return "then-missing"
    if word == "for":
        return _for(s)
    if word in _LABELS and s.at == 1:
        return "label-expected"
    if word == "FFT":
        return "fft-form" if s.at <= 2 or not s.wants_operand else ""
    if word == "SHOW" and (s.at == 1 or not s.wants_operand):
        return "show-form"
    if word == "display" and s.at == 1:
        return "display-mode"
    if word == "connect":
        return "file-name" if s.at == 1 else "connect-form" if not s.wants_operand else ""
    if word in _REQUESTS and s.at > 1 and not s.ended and s.kind not in _OPERANDS and s.after_operand:
        return "request-expression"
    if word in _WHOLE_ARRAYS and s.kind in ("[", "(") and "=" in s.expected:
        return "element-illegal"
    if word in _DEFINITIONS and not s.wants_operand:
        return "definition-form"
    if word in _LISTERS or (word == "note" and s.kind == "#"):
        s.facts["word"] = "note #" if word == "note" else word
        return "lines-form"
    if word in ("tdelay", "delay") and s.opened == "" and s.after_operand and "=" in s.kinds[: s.at]:
        return "delay-form"
    if word in ("func", "func2") and s.opened == "" and s.after_operand and "=" in s.kinds[: s.at]:
        return "table-form"
    if word in ("CLEARN", "PLEARN", "INTP") and not s.wants_operand and "=" in s.kinds[: s.at]:
        return "learn-form"
    bounded = ";" in s.kinds[: s.at] or (s.kind == "," and ";" in s.expected)
    if word in _WHOLE_ARRAYS and s.opened == "" and s.after_operand and bounded:
        return "bounds-form"
    if word == "trkhld" and (s.kind == "=" or s.ended) and s.after_operand:
        return "track-hold-form"
    if word == "ARRAY" and s.kind == "(":
        return "array-parenthesis"
    return ""


def _for(s: _Stuck) -> str:
    if s.at == 1:
        return "loop-variable-missing"
    if "to" in s.expected and s.after_operand and s.opened == "":
        return "to-expected"
    if "step" in s.expected and s.after_operand and s.opened == "":
        return "step-expected"
    return ""


def _matrix_function(s: _Stuck) -> str:
    """`$Foo(x)`, `$In A`: only `$In(A)` and `$Tr(A)` begin like this in an expression."""
    if s.kind != "$" or not s.wants_operand or s.chunk.kinds[s.at + 1 : s.at + 2] != [NAME]:
        return ""
    s.facts["matrix"] = shown(s.texts[s.at + 1])
    s.place(s.at, s.at + 1)
    return "matrix-function"


def _first_words(s: _Stuck) -> str:
    """Statements that do not begin as any does."""
    if s.texts[:3] == ["d", "/", "dt"] or (
        s.texts[0] == "d" and s.kinds[1:2] == ["/"] and s.kinds[3:4] == [NAME]
    ):
        s.place(0, 2)
        return "derivative-form"
    if s.texts[:2] == ["d", "/"] and s.texts[2:3] and s.texts[2].startswith("dt") and s.kind == "=":
        s.place(0, 2)
        s.facts["state"] = s.texts[2][2:]
        return "derivative-form"
    if s.word == NAME and s.kinds[1:3] == ["/", NAME] and s.texts[2] == "dt" and s.texts[0].startswith("d"):
        s.place(0, 2)
        s.facts["state"] = s.texts[0][1:]
        return "derivative-form"
    if s.at == 1 and s.word == NAME and s.kind == STRING and not s.text.strip("'"):
        s.place(0, 1)
        return "second-derivative"
    if s.kind == "=" and s.texts[:2] == ["der", "("]:
        s.place(0, s.at - 1)
        return "derivative-form"
    if s.at == 1 and s.word == NAME and (s.kind in _OPERANDS or s.kind == "#"):
        return not_a_statement(s)
    if s.at == 0 and s.kind not in ("=", *CLOSERS):
        mark = comment_mark(s.chunk)
        if mark is not None:
            s.start, s.end = mark.start, mark.end
            return mark.key
        return not_a_statement(s)
    if s.at == 1 and s.word not in CLASSES and s.expected == {"$END"}:
        return "go-where" if s.word == "go" else "only-comment"
    return ""


def not_a_statement(s: _Stuck) -> str:
    """Point at the first word and name the keyword that was perhaps meant."""
    s.place(0)
    s.facts["close"] = keyword_like(s.texts[0])
    return "not-a-statement"


def _assignments(s: _Stuck) -> str:
    if s.kind == "=" and s.word not in (*CLASSES, "(", "[", "+", "-") and "=" not in s.kinds[: s.at]:
        return ""
    if s.kind == "=" and "=" not in s.kinds[: s.at] and s.opened == "":
        s.place(0, max(0, s.at - 1))
        return "target-illegal" if s.at else "variable-missing"
    return ""


def _other_languages(s: _Stuck) -> str:
    """`2**3`, and comments behind a statement."""
    doubled = s.kind == s.previous and s.kind in ("*", "/")
    if doubled and s.kind == "*":
        s.place(s.at - 1, s.at)
        return "power-spelling"
    if doubled:
        s.place(s.at - 1, s.at)
        s.facts["text"] = "//"
    trailing = s.kind in ("#", ";", "%") and s.after_operand and not s.opened
    return "foreign-end" if doubled or trailing else ""


def _expressions(s: _Stuck) -> str:
    if s.kind in RELATIONS and s.after_operand:
        return "relation-misplaced"
    if "=" in s.expected and s.after_operand and "+" not in s.expected:
        s.facts["form"] = _ASSIGNING_FORMS.get(s.word, "name = expression")
        return "equals-missing"
    if NAME in s.expected and not s.wants_operand and not s.after_operand:
        return "variable-missing"
    if s.wants_operand and not s.after_operand:
        return "operand-missing"
    if (s.kind in _OPERANDS or s.kind in OPENERS.values()) and s.after_operand and "*" in s.expected:
        return _operator_missing(s)
    if s.opened == "[" and "," in s.expected and "]" not in s.expected:
        return "pair-form"
    if NAME in s.expected and not s.wants_operand:
        return "variable-missing"
    if s.wants_operand:
        return "operand-missing"
    return ""


def _operator_missing(s: _Stuck) -> str:
    """`2 x`, `x = 1 next`, and `sin x` where parentheses are meant."""
    if s.text in _BEGINNINGS:
        return "statement-end"
    name = s.texts[s.at - 1]
    if s.previous != NAME or name not in LIBRARY or s.kind not in _OPERANDS:
        return "operator-missing"
    s.place(s.at - 1)
    s.facts["name"] = name
    return "argument-bare"


_RULES: tuple[Callable[[_Stuck], str], ...] = (
    _relation_spelling, _mixed_brackets, _brackets, _matrix_function, _own_form, _first_words, _assignments,
    _other_languages, _expressions,
)  # fmt: skip


def _bare(text: str) -> str:
    """Return a token without quotes of its own, to be put into quotes."""
    return text.strip("'\"") or text if text[:1] in ("'", '"') else text


def _quoted(text: str) -> str:
    """Put a token into quotes, unless it has its own."""
    return text if text[0] in "'\"" else f"'{text}'"


def _open_bracket(kinds: list[str]) -> str:
    """Return the innermost bracket that is still open."""
    stack: list[str] = []
    for kind in kinds:
        if kind in OPENERS.values():
            stack.append(kind)
        elif kind in CLOSERS and stack:
            stack.pop()
    return stack[-1] if stack else ""
