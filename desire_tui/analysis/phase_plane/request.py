"""What is asked of a phase plane: `x, y in x = [0, 3], y = [0, 2] from x = 1, y = 1 without basins`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.analysis.request import Request
from desire_tui.engine.data_classes import dataclass, field

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

EXAMPLE = "phase x, y in x = [-2, 2], y = [-1, 1]"


@dataclass
class Asked:
    """Two states, None: those that the program displays; their limits; places by name; what is left out."""

    names: tuple[str, str] | None = None
    limits: dict[str, tuple[float, float]] = field(default_factory=dict)
    starts: list[dict[str, float]] = field(default_factory=list)
    has_basins: bool = True


def read(request: str, states: Sequence[str]) -> Asked:
    """Read a request. DesireError 520: it is not written as it has to be."""
    words, asked = Request(request, EXAMPLE), Asked()
    if not words.is_done and words.peek() not in ("in", "from", "without"):
        first = _state(words, states)
        words.expect(",")
        span = words.span
        second = _state(words, states)
        if second == first:
            words.fail(f"'{second}' stands twice", "two different states", span)
        asked.names = first, second
    if words.take("in"):
        for name in _each(words, states):
            asked.limits[name] = words.interval()
    while words.take("from"):
        start = {}
        for name in _each(words, states):
            start[name] = words.number()
        asked.starts.append(start)
    if words.take("without"):
        words.expect("basins")
        asked.has_basins = False
    words.end()
    return asked


def _each(words: Request, states: Sequence[str]) -> Iterator[str]:
    """Yield the names of `x = …, y = …`; the caller reads what stands behind each `=`."""
    while True:
        name = _state(words, states)
        words.expect("=")
        yield name
        if not words.take(","):
            return


def _state(words: Request, states: Sequence[str]) -> str:
    span = words.span
    return words.known(words.name("a state"), states, "state", span)
