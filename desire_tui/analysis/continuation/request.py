"""What is asked of a continuation: `k in [0, 2], r in [1, 3] from fold 1 without cycles`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from desire_tui.analysis.continuation.equilibrium_curve import Range
from desire_tui.analysis.request import Request
from desire_tui.engine.data_classes import dataclass, field

if TYPE_CHECKING:
    from collections.abc import Iterable

EXAMPLE = "continue k in [0, 2]"

_SPECIAL = {"fold": "fold", "Hopf": "Hopf", "hopf": "Hopf", "period": "period doubling"}
"""First words of points that are continued over two parameters."""
From = Literal["run", "here", "place", "cycle", "special"]


@dataclass
class Asked:
    """The parameters with their ranges, one or two, and where it begins.

    `place` holds states by name, `special` the kind and the number of a point of the first parameter's
    diagram that is followed over both; None: all folds and Hopf points, or of the run's cycle (`origin`
    cycle) all folds of cycles and period doublings.
    """

    over: list[Range]
    origin: From = "run"
    place: dict[str, float] = field(default_factory=dict)
    special: tuple[str, int] | None = None
    has_cycles: bool = True


def read(request: str, parameters: Iterable[str], states: Iterable[str]) -> Asked:
    """Read a request. DesireError 520: it is not written as it has to be."""
    words = Request(request, EXAMPLE)
    known = tuple(parameters)
    asked = Asked([_range(words, known)])
    if words.take(","):
        span = words.span
        asked.over.append(_range(words, known))
        if asked.over[1].name == asked.over[0].name:
            words.fail(f"'{asked.over[1].name}' is continued already", "two different parameters", span)
        asked.origin = "special"
    if words.take("from"):
        _origin(words, asked, tuple(states))
    if words.take("without"):
        words.expect("cycles")
        asked.has_cycles = False
    words.end()
    return asked


def _special(words: Request) -> tuple[str, int]:
    """Read `fold 1`, `Hopf 2`, `fold of cycles 1`, `period doubling 3`."""
    span = words.span
    kind = words.take(*_SPECIAL)
    if not kind:
        what = "over two parameters, folds, Hopf points, folds of cycles and period doublings are continued"
        words.fail(what, "from fold 1", span)
    name = _SPECIAL[kind]
    if kind == "fold" and words.take("of"):
        words.expect("cycles")
        name = "fold of cycles"
    elif kind == "period":
        words.expect("doubling")
    span = words.span
    number = words.number("its number")
    if number < 1 or number != int(number):
        words.fail("the number of a point is 1 or more", f"from {name} 1", span)
    return name, int(number)


def _range(words: Request, known: tuple[str, ...]) -> Range:
    span = words.span
    name = words.known(words.name("a parameter"), known, "parameter", span)
    words.expect("in")
    return Range(name, *words.interval())


def _origin(words: Request, asked: Asked, states: tuple[str, ...]) -> None:
    if len(asked.over) == 2:
        if words.take("cycle"):
            asked.origin = "cycle"
            if words.peek() not in _SPECIAL:
                return
        asked.special = _special(words)
        return
    span = words.span
    kind = words.take("here", "cycle", *_SPECIAL)
    if kind in _SPECIAL:
        words.fail(
            "folds, Hopf points and the like are continued over two parameters",
            "continue k in [0, 2], r in [1, 3] from fold 1",
            span,
        )
    if kind:
        asked.origin = "here" if kind == "here" else "cycle"
        return
    asked.origin = "place"
    while True:
        span = words.span
        name = words.known(words.name("a state, or here or cycle"), states, "state", span)
        words.expect("=")
        asked.place[name] = words.number()
        if not words.take(","):
            return
