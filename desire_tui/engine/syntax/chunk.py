"""The tokens of one statement, and what can be wrong with them.

A token's kind is its own text for operators and keywords (aliases replaced), or one of the classes below.
"""

from __future__ import annotations

from dataclasses import dataclass, field

NAME, NUMBER, OCTAL, STRING = "NAME", "NUMBER", "OCTAL", "STRING"
RAW, LETTER, MATFUN = "RAW", "LETTER", "MATFUN"
CLASSES = frozenset({NAME, NUMBER, OCTAL, STRING, RAW, LETTER, MATFUN})
OPERAND_END = frozenset({NAME, NUMBER, OCTAL, STRING, LETTER, ")", "]", "}", "%", "#"})
"""Kinds of tokens behind which an operator may follow."""


@dataclass(frozen=True, slots=True)
class Fault:
    """Something wrong in a statement: wording key, place counted from the statement's start, facts."""

    key: str
    start: int
    end: int
    facts: dict[str, object] = field(default_factory=dict)


@dataclass(slots=True)
class Chunk:
    """The tokens of one statement; positions count from the first, which stands at `base` of the line."""

    base: int
    kinds: list[str] = field(default_factory=list)
    texts: list[str] = field(default_factory=list)
    starts: list[int] = field(default_factory=list)
    ends: list[int] = field(default_factory=list)
    fault: Fault | None = None

    def add(self, kind: str, text: str, start: int, end: int) -> None:
        """Append a token that stands at `start` … `end` of the line."""
        self.kinds.append(kind)
        self.texts.append(text)
        self.starts.append(start - self.base)
        self.ends.append(end - self.base)


@dataclass(slots=True)
class Line:
    """A logical line: its statements, its comments' places, and whether it goes on in the next line."""

    chunks: list[Chunk]
    comments: list[tuple[int, int]]
    continues: bool
