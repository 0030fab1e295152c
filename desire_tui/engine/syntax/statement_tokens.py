"""The tokens of one statement, and what can be wrong with them.

A token's kind is its own text for operators and keywords (aliases replaced), or one of the classes below.
Plain classes, not dataclasses: those cost 1 ms each at every start.
"""

from __future__ import annotations

NAME, NUMBER, OCTAL, STRING = "NAME", "NUMBER", "OCTAL", "STRING"
RAW, LETTER, MATFUN = "RAW", "LETTER", "MATFUN"
PRIME = "'"
"""The mark of a derivative, `x' = …`."""
CLASSES = frozenset({NAME, NUMBER, OCTAL, STRING, RAW, LETTER, MATFUN})
OPERAND_END = frozenset({NAME, NUMBER, OCTAL, STRING, LETTER, ")", "]", "}", "%", "#"})
"""Kinds of tokens behind which an operator may follow."""


QUOTED_MAX = 40


class TokenFault:
    """Something wrong in a statement: wording key, place counted from the statement's start, facts.

    `meant` is the first word of a statement of which nothing else is known, "" where there is none.
    """

    __slots__ = ("end", "facts", "key", "meant", "start")

    def __init__(self, key: str, start: int, end: int, facts: dict[str, object] | None = None) -> None:
        self.key, self.start, self.end = key, start, end
        self.facts = facts if facts is not None else {}
        self.meant = ""


def shown(text: str) -> str:
    """Return a text as messages quote it: its beginning, if it is long."""
    return text if len(text) <= QUOTED_MAX else f"{text[: QUOTED_MAX - 1]}…"


class StatementTokens:
    """The tokens of one statement; positions count from the first, which stands at `base` of the line."""

    __slots__ = ("base", "ends", "fault", "kinds", "starts", "texts")

    def __init__(self, base: int, fault: TokenFault | None = None) -> None:
        self.base = base
        self.kinds: list[str] = []
        self.texts: list[str] = []
        self.starts: list[int] = []
        self.ends: list[int] = []
        self.fault = fault

    def add(self, kind: str, text: str, start: int, end: int) -> None:
        """Append a token that stands at `start` … `end` of the line."""
        self.kinds.append(kind)
        self.texts.append(text)
        self.starts.append(start - self.base)
        self.ends.append(end - self.base)


_COMMENT_MARKS = frozenset({"#", "##", ";", "%", "%%"})


def comment_mark(chunk: StatementTokens) -> TokenFault | None:
    """Return the fault of a statement that begins with another language's comment mark, None for others."""
    kinds, fault = chunk.kinds, chunk.fault
    if not kinds or (fault is not None and fault.start < chunk.starts[0]):
        marked, end = fault is not None and fault.facts.get("char") == "!", 1
    else:
        two = kinds[0] == "/" and kinds[1:2] in (["/"], ["*"])
        marked, end = two or kinds[0] in _COMMENT_MARKS, chunk.ends[1 if two else 0]
    return TokenFault("comment-mark", 0, end) if marked else None


class LogicalLine:
    """A logical line: its statements, its comments' places, and what makes it go on in the next line.

    `continues` is an operator, `_`, or the quote of a string that `_` carries over; empty if nothing does.
    """

    __slots__ = ("chunks", "comments", "continues")

    def __init__(
        self, chunks: list[StatementTokens], comments: list[tuple[int, int]], *, continues: str
    ) -> None:
        self.chunks, self.comments, self.continues = chunks, comments, continues
