"""Indentation and comments: text in, text out."""

from __future__ import annotations

import re

from desire_tui.language.line_tokens import tokens_of

WIDTH = 2
"""Blanks a level."""

OPENING = frozenset({"for", "while", "repeat", "PROCEDURE", "SUBMODEL"})
CLOSING = frozenset({"next", "until", "end", "end if", "end while", "proceed"})
"""First words of statements; `else` closes a block and opens another."""
COMMENT = re.compile(r"^(\s*)--\s?")
JOINED = re.compile(r"(.?)_[ \t\r]*\Z")


def _first_words(line: str) -> list[str]:
    """Return the kind of each statement's first token: a keyword in its main spelling, `NAME` for a name."""
    return [statement[0].kind for statement in tokens_of(line).statements if statement]


def opens(line: str) -> bool:
    """Whether a block begins in the line that does not end in it."""
    words = _first_words(line)
    if not words or CLOSING.intersection(words[1:]):
        return False
    if words[0] == "if":
        return tokens_of(line).statements[-1][-1].kind == "then"
    return words[0] in OPENING or words == ["else"]


def closes(line: str) -> bool:
    """Whether the line ends a block, so that it belongs one level further left."""
    words = _first_words(line)
    return bool(words) and (words[0] in CLOSING or words[0] == "else")


def indent_after(line: str, rows_above: str = "") -> str:
    """Return the blanks that a line after this one starts with.

    `rows_above` are the rows of a statement that goes on in this line. Behind a `_` within a word or a
    string there are none: they would become part of it.
    """
    joined = JOINED.search(line)
    if joined is not None and not tokens_of(rows_above + line).comments:
        return _blanks(line) if joined[1] in (" ", "") else ""
    text = rows_above + line
    return _blanks(text) + " " * WIDTH if opens(text) else _blanks(text)


def _blanks(line: str) -> str:
    return line[: len(line) - len(line.lstrip(" \t"))]


def closing_indent(lines: list[str], row: int) -> str | None:
    """Return the blanks of the line that opens the block which line `row` closes; None if there is none."""
    from desire_tui.engine.syntax.statement_rows import whole

    depth = 0
    for at in range(row - 1, -1, -1):
        line = whole(lines, at)
        words = _first_words(line)
        if CLOSING.intersection(words[1:]):
            continue
        if words[:1] == ["else"]:
            continue
        if closes(line):
            depth += 1
        elif opens(line):
            if depth == 0:
                return _blanks(line)
            depth -= 1
    return None


def toggle_comment(lines: list[str]) -> list[str]:
    """Put `-- ` before every line that is not blank; if all of them are comments, take it away."""
    filled = [line for line in lines if line.strip()]
    if filled and all(COMMENT.match(line) for line in filled):
        return [COMMENT.sub(r"\1", line) for line in lines]
    margin = min((len(line) - len(line.lstrip()) for line in filled), default=0)
    return [f"{line[:margin]}-- {line[margin:]}" if line.strip() else line for line in lines]


def shift(lines: list[str], levels: int) -> list[str]:
    """Indent (`levels` > 0) or dedent lines."""
    if levels > 0:
        return [" " * (WIDTH * levels) + line if line.strip() else line for line in lines]
    most = -levels * WIDTH
    return [line[min(most, len(line) - len(line.lstrip(" "))) :] for line in lines]
