"""Reading what stands behind `--over`, `--sample` and `--keep`: pieces with places, what is wrong."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.session.overrides import name_and_subscripts
from desire_tui.engine.source import Source, Span

if TYPE_CHECKING:
    from collections.abc import Iterator

_OPENING, _CLOSING = "([", ")]"


class Piece(NamedTuple):
    """A part of a text, without blanks around it, and where it begins there."""

    text: str
    at: int
    whole: Source

    def part(self, start: int, end: int | None = None) -> Piece:
        """Return the part of it between two offsets."""
        text = self.text[start:end]
        blanks = len(text) - len(text.lstrip())
        return Piece(text.strip(), self.at + start + blanks, self.whole)

    def wrong(self, what: str, remedy: str, **facts: object) -> DesireError:
        """Return the error that something is wrong here, and what to do."""
        span = Span(self.at, self.at + max(len(self.text), 1))
        told = {"what": what, "remedy": remedy, **facts}
        return DesireError(Diagnostic("study-form", span, told, self.whole))


def whole(text: str, name: str) -> Piece:
    """Return all of a text; `name` is what messages call it: `--keep`."""
    return Piece(text, 0, Source(text, name)).part(0)


def split(piece: Piece, mark: str = ",") -> Iterator[Piece]:
    """Yield what stands between marks that are in no bracket."""
    begin = 0
    for place in outside(piece.text):
        if piece.text[place] == mark:
            yield piece.part(begin, place)
            begin = place + 1
    yield piece.part(begin)


def outside(text: str) -> Iterator[int]:
    """Yield the offsets of those characters that are in no bracket, brackets themselves left out."""
    depth = 0
    for place, letter in enumerate(text):
        if letter in _OPENING:
            depth += 1
        elif letter in _CLOSING:
            depth = max(depth - 1, 0)
        elif depth == 0:
            yield place


def name_and_rest(piece: Piece, example: str) -> tuple[str, Piece]:
    """Return what stands before `=` (a scalar or an element) and what stands behind. DesireError 510."""
    at = next((k for k in outside(piece.text) if piece.text[k] == "="), None)
    if at is None:
        raise piece.wrong(f"'{piece.text}' names nothing that varies", f"for instance {example}")
    left, right = piece.part(0, at), piece.part(at + 1)
    try:
        name, subscripts = name_and_subscripts(left.text)
    except ValueError:
        told = f"'{left.text}' is no name of a quantity"
        raise left.wrong(told, f"a name, a, or an array's element, a[2]: {example}") from None
    if not right.text:
        raise piece.wrong(f"'{piece.text}' has nothing behind =", f"for instance {example}")
    return f"{name}[{','.join(map(str, subscripts))}]" if subscripts else name, right


def number(piece: Piece, example: str) -> float:
    """Return a finite number. DesireError 510."""
    try:
        value = float(piece.text)
    except ValueError:
        value = float("nan")
    if not isfinite(value):
        raise piece.wrong(f"'{piece.text}' is no number", f"for instance {example}")
    return value
