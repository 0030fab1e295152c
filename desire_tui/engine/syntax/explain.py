"""Finds the plain words for a token that cannot stand where it stands."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import closest
from desire_tui.engine.syntax.tokens import KEYWORDS, LETTER, NAME, NUMBER, OCTAL, STRING, Fault

if TYPE_CHECKING:
    from desire_tui.engine.syntax.tokens import Chunk

_OPERANDS = frozenset({NAME, NUMBER, OCTAL, STRING})
_OPERAND_END = frozenset({NAME, NUMBER, OCTAL, STRING, LETTER, ")", "]", "}", "%"})


def explain(chunk: Chunk, at: int, expected: frozenset[str]) -> Fault:
    """Return the fault of a statement whose token number `at` is none of the `expected` kinds."""
    kinds, texts = chunk.kinds, chunk.texts
    ended = at >= len(kinds)
    start, end = (chunk.ends[-1], chunk.ends[-1] + 1) if ended else (chunk.starts[at], chunk.ends[at])
    kind = "" if ended else kinds[at]
    word = kinds[0]
    facts: dict[str, object] = {"text": "" if ended else texts[at], "word": word, "first": texts[0]}
    previous = kinds[at - 1] if at else ""

    def fault(key: str) -> Fault:
        return Fault(key, start, end, facts)

    opened = _open_bracket(kinds[:at])
    if opened == "(" and ")" in expected:
        if ended or kind not in _OPERANDS:
            return fault("parenthesis-unclosed")
    if kind == ")" and opened != "(":
        return fault("parenthesis-stray")
    if opened in ("[", "{") and (ended or kind in {")", "]", "}", "="}) and previous in _OPERAND_END:
        return fault("bracket-unclosed")
    if kind in ("]", "}") and not opened:
        return fault("bracket-stray")
    if word == "if" and ended and previous in _OPERAND_END and "then" in expected:
        return fault("then-missing")
    if word == "for" and {"to", "step"} & expected and previous in _OPERAND_END:
        return fault("to-expected" if "to" in expected else "step-expected")
    if at == 1 and word == NAME and (ended or kind in _OPERANDS):
        close = closest(texts[0], KEYWORDS)
        if close:
            facts["close"] = close
        return Fault("not-a-statement", chunk.starts[0], chunk.ends[0], facts)
    if at == 0:
        return fault("not-a-statement")
    if "=" in expected and previous in _OPERAND_END and not {"+", "*"} & expected:
        return fault("equals-missing")
    if NAME in expected and NUMBER not in expected:
        return fault("variable-missing")
    if NUMBER in expected:
        return fault("operand-missing" if ended or kind not in CLOSING else "operand-missing")
    if kind in _OPERANDS and previous in _OPERAND_END and "*" in expected:
        return fault("operator-missing")
    return fault("statement-end")


CLOSING = frozenset({")", "]", "}"})


def _open_bracket(kinds: list[str]) -> str:
    stack: list[str] = []
    for kind in kinds:
        if kind in ("(", "[", "{"):
            stack.append(kind)
        elif kind in CLOSING and stack:
            stack.pop()
    return stack[-1] if stack else ""
