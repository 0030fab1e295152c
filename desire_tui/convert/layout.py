"""Lines of a program: comments, long lines broken where Desire goes on reading, short statements joined."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

WIDTH = 100
_INDENT = "    "


def comment_lines(comment: str) -> Iterator[str]:
    """Yield a comment's lines behind `--`."""
    for line in comment.splitlines():
        yield f"-- {line.strip()}".rstrip()


def broken(statement: str) -> Iterator[str]:
    """Yield a statement in lines of at most WIDTH characters, where it has places to break it.

    A line goes on in the next if it ends in an operator, or in `_`. Quoted texts stay whole.
    """
    rest, indent = statement, ""
    while len(indent) + len(rest) > WIDTH:
        cut = _break_before(rest, WIDTH - len(indent) - 2)
        if cut is None:
            break
        first, rest = rest[:cut].rstrip(), rest[cut:].lstrip()
        yield indent + first + ("" if first[-1] in "+-*/" else " _")
        indent = _INDENT
    yield indent + rest


def _break_before(text: str, most: int) -> int | None:
    """Return where a text of more than `most` characters is best broken; None: nowhere."""
    depth, quoted = 0, False
    places: list[tuple[int, int]] = []
    for at, sign in enumerate(text[:most]):
        if sign == "'":
            quoted = not quoted
        elif quoted:
            continue
        elif sign in "([":
            depth += 1
        elif sign in ")]":
            depth -= 1
        elif (sign in "+-" and text[at - 1 : at + 2] == f" {sign} ") or (sign == "," and at > most // 2):
            places.append((at + 1, depth))
        elif sign in "*/" and at > most // 2:
            places.append((at + 1, depth + 1))  # between terms rather than inside one
    if not places:
        blank = text.rfind(" ", 0, most)
        return None if blank <= 0 or quoted else blank + 1
    far = [place for place in places if place[0] > most // 2] or places
    least = min(depth for _, depth in far)
    return max(at for at, depth in far if depth == least)


def joined(statements: Iterable[str]) -> Iterator[str]:
    """Yield lines of short statements side by side, long ones alone."""
    line = ""
    for statement in statements:
        if line and len(line) + 3 + len(statement) > WIDTH:
            yield from broken(line)
            line = ""
        line = f"{line} | {statement}" if line else statement
    if line:
        yield from broken(line)
