"""Segments of a program that is run again and again: compiled once, where all names mean the same."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.values import Layout, Values

    Key = tuple[str, str | None, int]
    """The program's text, a segment's label, the rule."""
    Way = tuple[int, bool]
    """The rule, and whether its steps go beyond communication points."""


class RememberedSegments:
    """What a lowering and a compilation found and left in the values, for runs that begin with the same.

    A script that is run anew declares its names in the same order, so they get the same slots: where names,
    shapes, what is defined and the numbers that were compiled in are what they were, so is the segment.
    """

    def __init__(self, values: Values) -> None:
        self._values = values
        self._lowered: dict[Key, tuple[Layout, Layout, Segment]] = {}
        self._modelled: dict[tuple[int, Way], tuple[Layout, Layout]] = {}
        self._ready: set[tuple[int, Way]] = set()

    def begin(self) -> None:
        """All names were cleared: what models need besides has to be laid out again."""
        self._ready.clear()

    def segment(self, key: Key, lower: Callable[[], Segment]) -> Segment:
        """Return the segment as it was lowered before in the same circumstances, or lower it. DesireError."""
        values, known = self._values, self._lowered.get(key)
        before = values.layout()
        if known is not None and known[0] == before and self._holds(known[2]):
            values.lay_out(known[1])
            return known[2]
        made = lower()
        self._lowered[key] = before, values.layout(), made
        return made

    def may_use_model(self, segment: Segment, way: Way) -> bool:
        """Whether the model made before has its own numbers again where it looks for them."""
        key = id(segment), way
        if key in self._ready:
            return True
        known = self._modelled.get(key)
        if known is None or known[0] != self._values.layout():
            return False
        self._values.lay_out(known[1])
        self._ready.add(key)
        return True

    def forget_models(self, segment: Segment, way: Way) -> bool:
        """Forget all models if one of this segment is remembered; whether there was one."""
        if (id(segment), way) not in self._modelled:
            return False
        self._modelled.clear()
        self._ready.clear()
        return True

    def note_model(self, segment: Segment, way: Way, before: Layout) -> None:
        """Remember what making a model has left in the values."""
        self._modelled[id(segment), way] = before, self._values.layout()
        self._ready.add((id(segment), way))

    def _holds(self, segment: Segment) -> bool:
        """Whether the numbers that a segment was compiled with are what they were."""
        cells = self._values.cells
        return all(cells[slot] == value for slot, value in segment.constants)
