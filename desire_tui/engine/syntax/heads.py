"""The first word of a statement: whether it is a keyword, and what only this keyword allows behind it."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from desire_tui.engine.syntax.statement_tokens import LETTER, NAME, RAW, STRING
from desire_tui.engine.syntax.words import KEYWORDS, RAW_AFTER

if TYPE_CHECKING:
    from desire_tui.engine.syntax.statement_tokens import StatementTokens

_ASKING = frozenset({"if", "while", "until"})
_SECOND_WORD = {
    "go": re.compile(r"[ \t]+(to)(?![A-Za-z0-9$_])"),
    "end": re.compile(r"[ \t]+(if|while|event)(?![A-Za-z0-9$_])"),
}
_D_DT = re.compile(r"[ \t]*(d/dt)(?![A-Za-z0-9$_])")
_DELTA = re.compile(r"[ \t]*(delta)(?=[ \t]+[A-Za-z])")
_NAMED = re.compile(r"[ \t]+[A-Za-z]")
_OF_ARRAYS = frozenset({"delta", "UPDATE"})
"""Likely names of variables: keywords only where a name follows."""
_TITLES = frozenset({"title", "xlabel", "ylabel", "units"})
_QUOTED = re.compile(r"[ \t]*['\"]")
_MOMENTS = frozenset({"event", "every"})
_ALONE = re.compile(r"[ \t\r]*(?:\n|\||--|\Z)")
_OPERAND = re.compile(r"[ \t]+(?:[A-Za-z0-9.(]|[-+](?![ \t]))|[ \t]*(?:\n|\||--|\Z)")
"""Behind a word of moments; `event - 1` and `every/2` are expressions of a program's own variables."""
_BEYOND = frozenset({"compare", "notebook", "snapshot"})
"""Words that the original does not have: a program's own submodels of these names win."""
_RUN = re.compile(r"[ \t]+(run)(?![A-Za-z0-9$_])")
_RANGE = r"[0-9]+(?:[ \t]*[-\u2013][ \t]*[0-9]+)?"
_LINES = re.compile(rf"[ \t]*({_RANGE}(?:[ \t]*[,;][ \t]*{_RANGE})*)(?=[ \t\r]*(?:\n|\||--|\Z|else|proceed))")
_COPIED = re.compile(r"[ \t]*#(?=[ \t]*[0-9])")
_ABOUT_LINES = frozenset({"edit", "ed", "list", "list+", "auto"})
"""Commands that may name lines of the program: `edit 210-240,260`."""
_ASSIGNED = re.compile(r"[ \t]*=")
_SUBSCRIPTED = re.compile(r"[ \t]*\[")
_BRACKETS = re.compile(r"[\[\]|\n]")
_MODE = re.compile(
    r"[ \t]*(?:([ABCFNQRWY]|(?:fit|log[xy]|loglog|linear|equal)(?![0-9]))(?![A-Za-z$_\[(])"
    r"|([012])(?=[ \t\r]*(?:\n|\||--|\Z|else|proceed)))"
)
_FFT_KIND = re.compile(r"[ \t]*([FIRC])(?=[ \t]*[,;])")
_REST = re.compile(r"[ \t]*((?:'[^'\n]*'|\"[^\"\n]*\"|(?!--|—)[^|\n'\"])*)")


def add_head(chunk: StatementTokens, text: str, lexeme: str, start: int, pos: int) -> int:
    """Add a statement's first word and what only this keyword allows behind it; return where to go on."""
    kind = KEYWORDS.get(lexeme)
    if lexeme == "d" and (found := _D_DT.match(text, start)):
        chunk.add("d/dt", "d/dt", start, found.end())
        return found.end()
    if kind is None or _is_variable(text, lexeme, pos) or _gives_way(text, lexeme, pos):
        chunk.add(NAME, lexeme, start, pos)
        return pos
    second = _SECOND_WORD.get(lexeme)
    if second and (found := second.match(text, pos)):
        kind, pos = f"{lexeme} {found[1]}", found.end()
    elif lexeme in ("list", "keep") and text.startswith("+", pos):
        kind, pos = f"{lexeme}+", pos + 1
    chunk.add(kind, text[start:pos], start, pos)
    if kind in RAW_AFTER:
        return _rest(chunk, text, pos)
    if kind in ("Vector", "MATRIX"):
        found = _D_DT.match(text, pos) or (_DELTA.match(text, pos) if kind == "Vector" else None)
        if found:
            chunk.add(found[1], found[1], found.start(1), found.end())
            return found.end()
    elif kind == "display":
        if found := _MODE.match(text, pos):
            group = found.lastindex or 0
            chunk.add(LETTER, found[group], found.start(group), found.end(group))
            return found.end(group)
    elif kind == "FFT":
        if found := _FFT_KIND.match(text, pos):
            chunk.add(LETTER, found[1], found.start(1), found.end(1))
            return found.end(1)
    elif kind in _ABOUT_LINES or kind == "note":
        copied = _COPIED.match(text, pos)
        if (found := _LINES.match(text, copied.end() if copied else pos)) and (kind == "note") == bool(
            copied
        ):
            chunk.add(RAW, found[1], found.start(1), found.end(1))
            return found.end(1)
    elif kind == "dump" and (found := _RUN.match(text, pos)):
        chunk.add("run", "run", found.start(1), found.end())
        return found.end()
    return pos


def _gives_way(text: str, lexeme: str, pos: int) -> bool:
    """Whether a word that is a likely name is one: `delta` alone, or a submodel's call `compare(a, b)`."""
    if lexeme in _OF_ARRAYS:
        return not _NAMED.match(text, pos)
    if lexeme in _TITLES:
        return not _QUOTED.match(text, pos)
    if lexeme in _MOMENTS:
        return not _OPERAND.match(text, pos)
    if lexeme == "fast":
        return not _ALONE.match(text, pos)
    return lexeme in _BEYOND and text.startswith("(", pos)


def _is_variable(text: str, lexeme: str, pos: int) -> bool:
    """Whether the keyword that ends at `pos` is assigned like a variable: `input = 0`, `data[3] = 1`."""
    if _ASSIGNED.match(text, pos):
        return True
    if lexeme in _ASKING and not text.startswith("[", pos):
        return False  # `if [a, b] = z then` compares complex numbers
    found = _SUBSCRIPTED.match(text, pos)
    if not found:
        return False
    depth = 1
    for bracket in _BRACKETS.finditer(text, found.end()):
        mark = bracket[0]
        depth += 1 if mark == "[" else -1 if mark == "]" else 0
        if depth == 0:
            return _ASSIGNED.match(text, bracket.end()) is not None
        if mark in "|\n":
            break
    return False


def _rest(chunk: StatementTokens, text: str, pos: int) -> int:
    """Add the rest of the statement as one token, a string if it is one."""
    found = _REST.match(text, pos)
    assert found is not None
    rest = found[1].rstrip()
    if rest:
        start = found.start(1)
        whole = rest[0] in "'\"" and rest.find(rest[0], 1) == len(rest) - 1
        chunk.add(STRING if whole else RAW, rest, start, start + len(rest))
    return found.end()
