"""Classes of a line's parts for an editor, from the parser's own tokens: the two cannot disagree."""

from __future__ import annotations

from functools import cache
from typing import Literal

from desire_tui.engine.syntax.logical_lines import numbered
from desire_tui.engine.syntax.statement_tokens import (
    LETTER,
    MATFUN,
    NAME,
    NUMBER,
    OCTAL,
    OPERAND_END,
    RAW,
    STRING,
)
from desire_tui.engine.syntax.tokens import scan

Class = Literal["keyword", "function", "system", "string", "comment", "number", "operator", "name"]

_CLASSES: dict[str, Class] = {
    NUMBER: "number", OCTAL: "number", STRING: "string", RAW: "string", LETTER: "keyword", MATFUN: "function",
}  # fmt: skip


@cache
def _known() -> tuple[frozenset[str], frozenset[str]]:
    """Names of library functions and of system variables; imported late, they bring NumPy."""
    from desire_tui.engine.library import LIBRARY
    from desire_tui.engine.values import SYSTEM_VARIABLES

    return frozenset(LIBRARY), frozenset(SYSTEM_VARIABLES) | {"PI"}


def highlight(text_line: str) -> list[tuple[int, int, Class]]:
    """Return (start, end, class) for the parts of one line, in order. A line number counts as a comment."""
    skipped = numbered(text_line)
    found: list[tuple[int, int, Class]] = [(0, skipped, "comment")] if skipped else []
    line = scan(text_line[skipped:])
    found += [(skipped + start, skipped + end, "comment") for start, end in line.comments]
    for chunk in line.chunks:
        kinds = chunk.kinds
        base = skipped + chunk.base
        for i, kind in enumerate(kinds):
            found.append((base + chunk.starts[i], base + chunk.ends[i], _class(chunk.texts, kinds, i, kind)))
    found.sort()
    return found


def _class(texts: list[str], kinds: list[str], i: int, kind: str) -> Class:
    if kind == NAME:
        text = texts[i]
        functions, system = _known()
        if text in system:
            return "system"
        if text in ("and", "or") and i and kinds[i - 1] in OPERAND_END:
            return "keyword"
        called = i + 1 < len(kinds) and kinds[i + 1] == "("
        return "function" if text in functions and called else "name"
    known = _CLASSES.get(kind)
    if known is not None:
        return known
    return "keyword" if kind[0].isalpha() else "operator"
