"""What a run starts with: the parameters that its segment reads and does not change, and the states.

Finding out which quantities these are takes longer than a short run. It waits until somebody asks or a second
run of the segment is made; until then a run keeps a copy of all numbers.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from desire_tui.engine.lowered.effects import memory, reads, writes
from desire_tui.engine.lowered.walk import walk_actions, walk_values
from desire_tui.engine.values import SCALAR_SLOTS, SYSTEM_SLOTS, Kind

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from numpy.typing import NDArray

    from desire_tui.engine.lowered.effects import Piece
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.statements import Action
    from desire_tui.engine.values import Quantity, Saved, Values

    Floats = NDArray[np.float64]

ELEMENTS_MOST = 16
"""Of larger arrays no element is kept."""
COPIED_MOST = 1 << 17
"""Of more numbers no copy is kept beyond the next run."""


class _Found(NamedTuple):
    names: tuple[str, ...]
    parameters: int
    """So many names are parameters, the others states."""
    slots: NDArray[np.intp]


class StartQuantities:
    """Which quantities a segment starts from."""

    def __init__(self, segment: Segment, values: Values) -> None:
        self._segment: Segment | None = segment
        self._quantities: tuple[Quantity, ...] = tuple(values.names.values())
        self._found: _Found | None = None
        self._last: StartValues | None = None
        self.states = np.array(
            [slot for states in segment.states for slot in range(states.slot, states.slot + states.count)]
            if segment.order <= COPIED_MOST
            else [],
            dtype=np.intp,
        )
        """Slots of the states."""

    def start(self, values: Values, saved: Saved | None, *, continues: bool) -> StartValues:
        """Return the values of a run that begins now; `saved` is a copy of all numbers, if there is one."""
        made = StartValues(self, saved, continues=continues)
        if saved is None or self._last is not None or values.numbers_used > COPIED_MOST:
            self.settle()
            made.condense(values)
        self._last = made
        return made

    def settle(self) -> None:
        """Let go of the copy that is kept for the last run."""
        if self._last is not None:
            self._last.condense()

    def forget(self) -> None:
        """Let go of the segment: nobody will ask what a run started with if nobody has yet."""
        if self._found is None:
            self._found = _Found((), 0, np.array([], dtype=np.intp))
            self._segment, self._quantities = None, ()
        self.settle()

    @property
    def found(self) -> _Found:
        """Names and slots, in the order of their slots."""
        if self._found is None:
            segment = self._segment
            assert segment is not None
            states = [(states.slot, states.count) for states in segment.states]
            read = {*_slots(_read(segment)), *(slot for slot, _ in segment.constants)}
            read -= {*_slots(piece for action in _actions(segment) for piece in writes(action))}
            of_states = {*_slots(states)}
            names = _names(self._quantities, read | of_states)
            parameters = sorted(slot for slot in read - of_states if slot in names)
            starts = sorted(slot for slot in of_states if slot in names)
            slots = [*parameters, *starts]
            found = tuple(names[slot] for slot in slots)
            self._found = _Found(found, len(parameters), np.array(slots, dtype=np.intp))
            self._segment, self._quantities = None, ()
        return self._found


class StartValues:
    """The values of one run. `continues`: the states are where the run before left them."""

    def __init__(self, quantities: StartQuantities, saved: Saved | None, *, continues: bool) -> None:
        self._quantities = quantities
        self._saved = saved
        self._values: Floats | None = None
        self.continues = continues

    def condense(self, now: Values | None = None) -> Floats:
        """Keep the values that are asked for, and no others; return them. At the start those of `now`."""
        if self._values is None:
            slots, saved = self._quantities.found.slots, self._saved
            if now is not None:
                self._values = now.data[slots]
            else:
                assert saved is not None
                self._values = _taken(saved, slots)
        self._saved = None
        return self._values

    @property
    def names(self) -> tuple[str, ...]:
        """Parameters, then states."""
        return self._quantities.found.names

    @property
    def values(self) -> Floats:
        """Their numbers, in the order of `names`."""
        return self.condense()

    @property
    def parameter_count(self) -> int:
        """So many of them are parameters."""
        return self._quantities.found.parameters

    @property
    def parameters(self) -> dict[str, float]:
        """Values of the quantities that the segment reads and does not change."""
        count = self.parameter_count
        return dict(zip(self.names[:count], self.values[:count].tolist(), strict=True))

    @property
    def initial(self) -> dict[str, float]:
        """Values of the states."""
        count = self.parameter_count
        return dict(zip(self.names[count:], self.values[count:].tolist(), strict=True))


def start_slots(segment: Segment) -> NDArray[np.intp]:
    """Return all slots that a segment reads, and those of its states, in their order."""
    states = ((states.slot, states.count) for states in segment.states)
    found = {slot for first, count in (*_read(segment), *states) for slot in range(first, first + count)}
    return np.array(sorted(slot for slot in found if slot >= SYSTEM_SLOTS), dtype=np.intp)


def _actions(segment: Segment) -> Iterator[Action]:
    """Yield every statement of a segment, those of its events too."""
    for body in (segment.body, *(event.body for event in segment.events)):
        yield from walk_actions(body)


def _read(segment: Segment) -> Iterator[Piece]:
    """Yield what the statements read, and what decides when events come and how far delays reach."""
    for action in _actions(segment):
        yield from reads(action)
    times = [value for event in segment.events for value in (event.condition, event.period, event.start)]
    times += [value for delay in segment.delays for value in (delay.source, delay.tau)]
    for node in walk_values(*times):
        yield from memory(node)


def _slots(pieces: Iterable[tuple[int, int]]) -> Iterable[int]:
    for slot, count in pieces:
        if slot >= SYSTEM_SLOTS and count <= ELEMENTS_MOST:
            yield from range(slot, slot + count)


def _names(quantities: tuple[Quantity, ...], wanted: set[int]) -> dict[int, str]:
    """Return the names of slots; those of overlays by the array declared last."""
    names: dict[int, str] = {}
    for quantity in quantities:
        if not quantity.shape:
            if quantity.slot in wanted and quantity.kind is not Kind.COMPLEX:
                names[quantity.slot] = quantity.name
        elif quantity.slots == quantity.size <= ELEMENTS_MOST:
            for number, place in enumerate(np.ndindex(quantity.shape)):
                if quantity.slot + number in wanted:
                    names[quantity.slot + number] = f"{quantity.name}[{','.join(str(k + 1) for k in place)}]"
    return names


def _taken(saved: Saved, slots: NDArray[np.intp]) -> Floats:
    (_, scalars), (_, arrays) = saved.numbers
    values = np.empty(len(slots))
    is_scalar = slots < SCALAR_SLOTS
    values[is_scalar] = scalars[slots[is_scalar]]
    values[~is_scalar] = arrays[slots[~is_scalar] - SCALAR_SLOTS]
    return values
