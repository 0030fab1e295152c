"""Octal and hexadecimal numbers, malformed numbers, open quotes: what is rare or wrong in a line."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from desire_tui.engine.syntax.statement_tokens import (
    NAME,
    NUMBER,
    OCTAL,
    OPERAND_END,
    STRING,
    TokenFault,
    shown,
)

if TYPE_CHECKING:
    from desire_tui.engine.syntax.statement_tokens import StatementTokens

_OCTAL = re.compile(r"&[0-7]+\Z|&&[0-9A-Fa-f]+\Z")
_NUMBER_START = re.compile(r"(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_PRIME = re.compile(r"'[ \t]*=")
_EXPONENT = re.compile(r"[eE](?![A-Za-z])")


def add_odd(chunk: StatementTokens, group: int, lexeme: str, start: int) -> int:
    """Add a token of the rare `group` (tokens.py); return where to go on."""
    base, end = chunk.base, start + len(lexeme)
    fault = None
    if group == 8:
        if lexeme == "&":
            chunk.add("&", lexeme, start, end)
        elif lexeme == "&&" and chunk.kinds[-1:] and chunk.kinds[-1] in OPERAND_END:
            fault = TokenFault("logical-spelling", start - base, end - base, {"text": lexeme})
        elif _OCTAL.match(lexeme) and octal_in_range(lexeme):
            chunk.add(OCTAL, lexeme, start, end)
        elif lexeme[1].isalpha():
            end = start + 1
            chunk.add("&", "&", start, end)
        else:
            key = "octal-too-large" if _OCTAL.match(lexeme) else "octal-digits"
            fault = TokenFault(key, start - base, end - base, {"text": shown(lexeme)})
            chunk.add(OCTAL, "&0", start, end)
    elif group == 9:
        fault = TokenFault("quote-unclosed", start - base, end - base, {"quote": lexeme[0]})
        chunk.add(STRING, lexeme + lexeme[0], start, end)
    elif group == 10:
        good = _NUMBER_START.match(lexeme)
        rest = lexeme[good.end() :] if good is not None else "."
        if good is not None and rest[0] not in ".$_" and not _EXPONENT.match(rest):
            end = start + good.end()
            chunk.add(NUMBER, good[0], start, end)
        else:
            fault = TokenFault("number-format", start - base, end - base, {"text": shown(lexeme)})
            chunk.add(NUMBER, "0", start, end)
    else:
        keys = {"!=": "relation-spelling", ":=": "assignment-spelling", ":": "colon"}
        key = keys.get(lexeme, "strange-character")
        fault = TokenFault(key, start - base, end - base, {"char": lexeme, "text": lexeme, "right": "<>"})
    if chunk.fault is None:
        chunk.fault = fault
    return end


def is_prime(chunk: StatementTokens, text: str, start: int) -> bool:
    """Whether a quote marks a derivative, `x' = …` or `x[2]' = …`: no statement has a string there."""
    kinds = chunk.kinds
    if not kinds or kinds[0] != NAME or start - chunk.base != chunk.ends[-1] or not _PRIME.match(text, start):
        return False
    return len(kinds) == 1 or (kinds[1] == "[" and kinds[-1] == "]")


def too_large(lexeme: str) -> bool:
    """Whether a number is beyond the largest that 64 bits hold."""
    return float(lexeme) == float("inf")


def octal_in_range(lexeme: str) -> bool:
    """Whether an `&` or `&&` literal fits into 16 bits."""
    return _digits(lexeme) <= 0xFFFF


def octal_value(lexeme: str) -> float:
    """Value of `&17370` (octal) or `&&FC2` (hexadecimal): 16 bits, two's complement [B 8.3.2]."""
    bits = _digits(lexeme)
    return float(bits - 0x10000 if bits > 0x7FFF else bits)


def _digits(lexeme: str) -> int:
    return int(lexeme.lstrip("&"), 16 if lexeme.startswith("&&") else 8)
