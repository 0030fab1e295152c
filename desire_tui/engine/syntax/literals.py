"""Octal and hexadecimal numbers, malformed numbers, open quotes: what is rare or wrong in a line."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from desire_tui.engine.syntax.chunk import NUMBER, OCTAL, STRING, Fault

if TYPE_CHECKING:
    from desire_tui.engine.syntax.chunk import Chunk

_OCTAL = re.compile(r"&[0-7]+\Z|&&[0-9A-Fa-f]+\Z")
_NUMBER_START = re.compile(r"(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_EXPONENT = re.compile(r"[eE](?![A-Za-z])")


def add_odd(chunk: Chunk, group: int, token: str, start: int) -> int:
    """Add a token of the rare `group` (tokens.py); return where to go on."""
    base, end = chunk.base, start + len(token)
    fault = None
    if group == 8:
        if token == "&":
            chunk.add("&", token, start, end)
        elif _OCTAL.match(token) and octal_in_range(token):
            chunk.add(OCTAL, token, start, end)
        elif token[1].isalpha():
            end = start + 1
            chunk.add("&", "&", start, end)
        else:
            key = "octal-too-large" if _OCTAL.match(token) else "octal-digits"
            fault = Fault(key, start - base, end - base, {"text": token})
            chunk.add(OCTAL, "&0", start, end)
    elif group == 9:
        fault = Fault("quote-unclosed", start - base, end - base, {"quote": token[0]})
        chunk.add(STRING, token + token[0], start, end)
    elif group == 10:
        good = _NUMBER_START.match(token)
        rest = token[good.end() :] if good is not None else "."
        if good is not None and rest[0] not in ".$_" and not _EXPONENT.match(rest):
            end = start + good.end()
            chunk.add(NUMBER, good[0], start, end)
        else:
            fault = Fault("number-format", start - base, end - base, {"text": token})
            chunk.add(NUMBER, "0", start, end)
    else:
        fault = Fault("strange-character", start - base, end - base, {"char": token})
    if chunk.fault is None:
        chunk.fault = fault
    return end


def octal_in_range(token: str) -> bool:
    """Whether an `&` or `&&` literal fits into 16 bits."""
    return _digits(token) <= 0xFFFF


def octal_value(token: str) -> float:
    """Value of `&17370` (octal) or `&&FC2` (hexadecimal): 16 bits, two's complement [B 8.3.2]."""
    bits = _digits(token)
    return float(bits - 0x10000 if bits > 0x7FFF else bits)


def _digits(token: str) -> int:
    return int(token.lstrip("&"), 16 if token.startswith("&&") else 8)
