"""Indentation and comments: text in, text out."""

from __future__ import annotations

import re

WIDTH = 2
"""Blanks a level."""

_OPENS = re.compile(r"\s*(for|while|repeat|PROCEDURE|SUBMODEL|MACRO)\b(?!\s*=)")
_THEN = re.compile(r"\s*if\b(?!\s*=).*\bthen\s*(--.*)?$")
_ELSE = re.compile(r"\s*else\s*(--.*)?$")
_CLOSES = re.compile(r"\s*(next|until|end|proceed|else)\b(?!\s*=)")
_CLOSED = re.compile(r"\|\s*(next|until|end while|end|proceed)\b")
COMMENT = re.compile(r"^(\s*)--\s?")


def indent_after(line: str) -> str:
    """Return the blanks that a line after this one starts with."""
    blanks = line[: len(line) - len(line.lstrip())]
    opens = _OPENS.match(line) or _THEN.match(line) or _ELSE.match(line)
    return blanks + " " * WIDTH if opens and not _CLOSED.search(line) else blanks


def closes(line: str) -> bool:
    """Whether the line ends a block, so that it belongs one level further left."""
    return _CLOSES.match(line) is not None


def closing_indent(lines: list[str], row: int) -> str | None:
    """Return the blanks of the line that opens the block which line `row` closes; None if there is none."""
    depth = 0
    for at in range(row - 1, -1, -1):
        line = lines[at]
        if _CLOSED.search(line):
            continue
        if closes(line) and not _ELSE.match(line):
            depth += 1
        elif _OPENS.match(line) or _THEN.match(line):
            if depth == 0:
                return line[: len(line) - len(line.lstrip())]
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
