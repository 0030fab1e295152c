"""What a study keeps of each run: `x[end]`, `max(e)`, `t[miss<1]`, `y@0:2:0.1`."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Literal, get_args

import numpy as np

from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.diagnostics import closest
from desire_tui.engine.library import LIBRARY
from desire_tui.engine.session.kept_expressions import Expression, KeptExpressions
from desire_tui.studies.texts import number, outside, split, whole

if TYPE_CHECKING:
    from collections.abc import Container, Iterable, Iterator

    from desire_tui.studies.texts import Piece

Reduction = Literal["max", "min", "mean", "std", "integral", "first", "last"]
Kind = Reduction | Literal["when", "at"]
REDUCTIONS = get_args(Reduction)
EXAMPLE = "x[end], max(x), mean(x), t[x<1], x@2, x@0:2:0.1"
_ALIAS = re.compile(r"\s*([A-Za-z_]\w*)\s*=(?!=)", re.ASCII)
_CALL = re.compile(r"([A-Za-z]\w*)\s*\(", re.ASCII)
_OF_KEPT = re.compile(r"\[\s*end\s*\]|\b(max|min|mean|std|integral|first|last)\s*\((?!.*,)")
_NAME = re.compile(r"[A-Za-z][\w$]*(\[[^\[\]]*\])?", re.ASCII)
_RELATION = re.compile(r"[<>=]|\b(and|or|not)\b")
TIMES_MOST = 1_000_000


@dataclass(frozen=True)
class Kept:
    """One quantity: what the result calls it, the expression, what is made of its samples.

    `when`: the time of the first sample at which the expression is above 0. `at`: its values at `times`, a
    number alone where `single`, between samples by straight lines.
    """

    label: str
    expression: Expression
    kind: Kind
    times: tuple[float, ...] = ()
    single: bool = False

    @property
    def size(self) -> int:
        """How many numbers it is."""
        return len(self.times) if self.kind == "at" else 1


@dataclass(frozen=True)
class KeptList:
    """All that is kept of a run, as `text` says."""

    text: str
    items: tuple[Kept, ...]

    @property
    def size(self) -> int:
        """How many numbers are kept of a run."""
        return sum(item.size for item in self.items)

    def expressions(self, but: Container[int] = ()) -> KeptExpressions:
        """Return what has to be sampled, the expression of each item. DesireError: it is none.

        Items with the numbers in `but` are left out.
        """
        some = [item.expression for number, item in enumerate(self.items) if number not in but]
        return KeptExpressions(whole(self.text, "--keep").whole, some)


def kept(texts: str | Iterable[str]) -> KeptList:
    """Read what is to be kept. DesireError 510: what cannot be read, with its place and what to write."""
    text = texts if isinstance(texts, str) else ", ".join(texts)
    items = tuple(_item(piece) for piece in split(whole(text, "--keep")) if piece.text)
    if not items:
        raise whole(text, "--keep").wrong("nothing is kept of the runs", f"for instance {EXAMPLE}")
    seen = set[str]()
    for item in items:
        if item.label in seen:
            at = item.expression.at
            place = whole(text, "--keep")._replace(text=item.expression.text, at=at)
            raise place.wrong(
                f"'{item.label}' is kept twice", "leave one away, or give it a name: peak = max(x)"
            )
        seen.add(item.label)
    return KeptList(text, items)


def _item(piece: Piece) -> Kept:
    alias = _ALIAS.match(piece.text)
    label, body = (alias[1], piece.part(alias.end())) if alias else (piece.text, piece)
    text = body.text
    at = next((k for k in outside(text) if text[k] == "@"), None)
    if at is not None:
        times, single = _times(body.part(at + 1))
        return Kept(label, _expression(body.part(0, at)), "at", times, single)
    if text.endswith("]"):
        opening = _opening(text)
        inside = body.part(opening + 1, len(text) - 1)
        before = body.part(0, opening)
        if inside.text == "end" and before.text:
            return Kept(label, _expression(before), "last")
        if before.text == "t" and _RELATION.search(inside.text):
            return Kept(label, Expression(f"({inside.text})", inside.at - 1), "when")
    call = _CALL.match(text)
    if call and text.endswith(")") and _opening(text) == call.end() - 1:
        inside = body.part(call.end(), len(text) - 1)
        is_one = not any(inside.text[k] == "," for k in outside(inside.text))
        for kind in REDUCTIONS:
            if call[1] == kind and is_one and inside.text:
                return Kept(label, _expression(inside), kind)
        near = closest(call[1], REDUCTIONS)
        if near and is_one:
            raise body.wrong(f"'{text}' is no number of a run", "", close=f"{near}({inside.text})")
        if call[1] not in LIBRARY:
            raise body.wrong(
                f"'{call[1]}' is neither kept nor computed", f"there are {', '.join(REDUCTIONS)}"
            )
    if _OF_KEPT.search(text):
        told = f"'{text}' is computed from what is kept"
        raise body.wrong(told, "keep its parts, and compute with the results; or max(x - y), (x - y)[end]")
    example = text if _NAME.fullmatch(text) else "x"
    remedy = f"{example}[end] is its last value, max({example}) its largest, {example}@2 the one at t = 2"
    raise body.wrong(f"'{text}' has many values in a run", remedy)


def _expression(piece: Piece) -> Expression:
    if not piece.text:
        raise piece.wrong("an expression is missing here", f"for instance {EXAMPLE}")
    return Expression(piece.text, piece.at)


def _opening(text: str) -> int:
    """Return where the bracket opens that a text ends with; 0 if it does not open."""
    depth = 0
    for place in range(len(text) - 1, -1, -1):
        depth += (text[place] in ")]") - (text[place] in "([")
        if depth == 0:
            return place
    return 0


def _times(piece: Piece) -> tuple[tuple[float, ...], bool]:
    """Read `2`, `0:2:0.1` (from, to, step), `(0, 0.5, 2)`."""
    example = "x@2, x@0:2:0.1 (from, to, step), x@(0, 0.5, 2)"
    text = piece.text
    if text.startswith("(") and text.endswith(")"):
        return tuple(number(p, example) for p in split(piece.part(1, len(text) - 1))), False
    parts = list(split(piece, ":"))
    if len(parts) == 1:
        return (number(parts[0], example),), True
    if len(parts) != 3:
        raise piece.wrong(f"'{text}' names no times", f"for instance {example}")
    first, last, step = (number(part, example) for part in parts)
    if step == 0.0 or (last - first) / step < 0.0:
        raise parts[2].wrong(
            f"steps of {step:g} lead from {first:g} never to {last:g}", f"for instance {example}"
        )
    count = int((last - first) / step * (1 + 1e-9) + 1e-9) + 1
    if count > TIMES_MOST:
        raise piece.wrong(f"{count} times are more than {TIMES_MOST}", "take a larger step")
    return tuple((first + step * np.arange(count)).tolist()), False


def slices(items: Iterable[Kept]) -> Iterator[tuple[Kept, slice]]:
    """Yield each item with the place of its numbers among all that are kept of a run."""
    begin = 0
    for item in items:
        yield item, slice(begin, begin + item.size)
        begin += item.size
