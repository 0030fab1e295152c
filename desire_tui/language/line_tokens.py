"""Questions about one line of a program, answered by the engine's own tokens: they and the parser agree."""

from __future__ import annotations

import re
from functools import lru_cache
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Sequence

ANY_TEXT = frozenset({"STRING", "RAW"})
"""Kinds of tokens that hold text of any sort: strings, and what stands behind `help`, `keep` …."""
_WORD_AROUND = re.compile(r"[A-Za-z0-9_$]*")


class Token(NamedTuple):
    """A word, number or sign of a line, and the columns it stands in."""

    start: int
    end: int
    kind: str
    """As in `engine.syntax.statement_tokens`."""
    text: str

    @property
    def is_word(self) -> bool:
        """Whether it is a name or a keyword."""
        return self.text[:1].isalpha() and self.kind not in ANY_TEXT


class LineTokens(NamedTuple):
    """What a line holds, its line number left out."""

    statements: tuple[tuple[Token, ...], ...]
    comments: tuple[tuple[int, int], ...]
    """Where comments begin and end."""


@lru_cache(maxsize=4096)
def tokens_of(line: str) -> LineTokens:
    """Return the statements of a line and its comments."""
    from desire_tui.engine.syntax.logical_lines import numbered
    from desire_tui.engine.syntax.tokens import scan

    skipped = numbered(line)
    scanned = scan(line[skipped:])
    statements = []
    for chunk in scanned.chunks:
        base = skipped + chunk.base
        starts, ends = (base + at for at in chunk.starts), (base + at for at in chunk.ends)
        statements.append(tuple(map(Token, starts, ends, chunk.kinds, chunk.texts)))
    comments = tuple((skipped + start, skipped + end) for start, end in scanned.comments)
    return LineTokens(tuple(statements), comments)


def words_in(line: str) -> list[str]:
    """Return the names and keywords of a line in order; nothing out of comments and strings."""
    tokens = (token for statement in tokens_of(line).statements for token in statement if token.is_word)
    return [word for token in tokens for word in token.text.rstrip("+").split()]


def first_word(line: str) -> str:
    """Return what a line begins with: a name or a keyword (`end while`), else nothing."""
    statements = tokens_of(line).statements
    first = statements[0][0] if statements and statements[0] else None
    return first.text if first is not None and first.is_word else ""


def word_before(line: str, column: int) -> str:
    """Return the beginning of a word that ends at a column; empty inside a comment or a string."""
    before = line[:column]
    statements, comments = tokens_of(before)
    if not statements or not statements[-1] or any(end == column for _, end in comments):
        return ""
    last = statements[-1][-1]
    if last.end != column:
        return ""
    if last.kind == "RAW":  # what `help` and others get
        return word_before(last.text, len(last.text))
    if start := _derivative_begun(statements[-1]):
        return before[start.start :]
    word = before[last.start :].rpartition(" ")[2]  # of `end while`
    return word if last.is_word and word[-1:] != "+" else ""


def _derivative_begun(statement: tuple[Token, ...]) -> Token | None:
    """Return the `d` of a `d/dt` that is being typed at a statement's end: `d/`, `d/d`, `Vectr d/d`."""
    tokens = statement[1:] if statement[0].kind in {"Vector", "MATRIX"} else statement
    if len(tokens) not in {2, 3} or tokens[0].text != "d" or tokens[1].text != "/":
        return None
    adjacent = all(left.end == right.start for left, right in pairwise(tokens))
    return tokens[0] if adjacent and (len(tokens) == 2 or tokens[2].is_word) else None


def word_at(line: str, column: int) -> str:
    """Return the word or number that stands at a column or ends there, also inside comments and strings."""
    for statement in tokens_of(line).statements:
        for token in statement:
            if token.kind == "d/dt" and token.start <= column <= token.end:
                return token.text
    start = column
    while start > 0 and _WORD_AROUND.fullmatch(line, start - 1, column):
        start -= 1
    found = _WORD_AROUND.match(line, start)
    return found[0] if found is not None else ""


def joined_word_at(lines: Sequence[str], row: int, column: int) -> str:
    """Return the word at a place of a text; a whole one, though `_` may join it from several rows."""
    from desire_tui.engine.syntax.statement_rows import before, whole

    rows_above = before(lines, row)
    text = whole(lines, row - rows_above.count("\n"))
    at = len(rows_above) + column
    for statement in tokens_of(text).statements:
        for token in statement:
            joined = "\n" in text[token.start : token.end] and token.is_word
            if (joined or token.kind == "NAME") and token.start <= at <= token.end:
                return token.text
    return word_at(lines[row], column)


def listed_names(line: str) -> list[str]:
    """Return the names of a line that holds nothing else, separated by commas or semicolons; else none."""
    statements = tokens_of(line).statements
    if len(statements) != 1:
        return []
    words, separators = statements[0][::2], statements[0][1::2]
    fits = len(words) == len(separators) + 1 and all(token.text in {",", ";"} for token in separators)
    return [token.text for token in words] if fits and all(token.is_word for token in words) else []


def brackets_in(line: str) -> tuple[tuple[int, str], ...]:
    """Return the brackets of a line with their columns; none out of comments and strings."""
    statements = tokens_of(line).statements
    return tuple((t.start, t.text) for statement in statements for t in statement if t.text in set("()[]{}"))
