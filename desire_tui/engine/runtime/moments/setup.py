"""The memory behind a `Moments`."""

from __future__ import annotations

import ctypes
from math import ceil
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.integration.tableaus import whole_multiples
from desire_tui.engine.lowered.expressions import Load
from desire_tui.engine.runtime.moments.memory import Moments

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from desire_tui.engine.integration.tableaus import Tableau
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.values import Values

    Numbers = NDArray[np.float64]

SPAN = 1e-9
"""Part of COMINT within which very many events are too many."""
_ROOM = 4096
"""Knots of a history at first."""
_JUMPS = 4096
_SAME = 1e-9
"""Part of a period by which a run's start is one of its times."""


def first_tick(period: float, start: float, t: float) -> float:
    """Return the number of a clock's first time at `t` or later."""
    return max(0.0, float(ceil((t - start) / period - _SAME)))


class Past(Protocol):
    """What runs that continue one another hand on."""

    stepper: Stepper | Remembered | None


@dataclass(frozen=True)
class Remembered:
    """Histories of delays as they were at some time: knots, and jumps that come back."""

    knots: tuple[Numbers, Numbers, Numbers]
    """Times; values and slopes, a row for each delay."""
    jumps: Numbers
    smoothness: NDArray[np.int64]
    jump_at: NDArray[np.int64]

    @property
    def delay_count(self) -> int:
        """How many delays have a history."""
        return len(self.jump_at)

    def remembered(self) -> Remembered:
        """Return what never changes."""
        return self


class Stepper:
    """A model's `Moments` with everything that it points at; `tableau` None: there are no states."""

    def __init__(
        self, segment: Segment, tableau: Tableau | None, values: Values, like: Stepper | None = None
    ) -> None:
        """`like`: another one of the segment, for a run beside this one: both use the same slots."""
        self._kept: list[Any] = []
        events = segment.events
        count, order = len(events), segment.order
        self.moments = m = Moments()
        self._reals("values", values.data)
        m.count = count
        m.condition_count = sum(event.condition is not None for event in events)
        if like is None:
            m.now, m.due = values.room(max(count, 1)), values.room(max(count, 1))
            m.source = values.room(max(len(segment.delays), 1))
        else:
            m.now, m.due, m.source = like.moments.now, like.moments.due, like.moments.source
        for name in (
            "before",
            "at_left",
            "at_right",
            "fired",
            "ticks",
            "next",
            "came",
            "gap",
            "widest",
            "fell",
            "kept_before",
        ):
            self._reals(name, np.zeros(count))
        for name in (
            "armed",
            "in_doubt",
            "turned",
            "sooner",
            "shrunk",
            "quick",
            "arguments",
            "kept_armed",
            "kept_doubt",
        ):
            self._ints(name, np.zeros(count, dtype=np.int64))
        self._period, self._start = np.zeros(count), np.zeros(count)
        self._reals("period", self._period)
        self._reals("start", self._start)
        m.n = order
        ranges = [(states.slot, states.first, states.count) for states in segment.states]
        m.range_count = len(ranges)
        self._ints("ranges", np.array(ranges or [(0, 0, 0)], dtype=np.int64).reshape(-1))
        self._x0 = np.zeros(max(order, 1))
        self._reals("x0", self._x0)
        self._rule(tableau, max(order, 1))
        self._histories(segment)
        self.address = ctypes.addressof(m)

    def _histories(self, segment: Segment) -> None:
        m, count = self.moments, len(segment.delays)
        numbers = {s.slot + i: s.first + i for s in segment.states for i in range(s.count)}
        m.delay_count = count
        if not count:
            return
        slots = [d.source.slot if isinstance(d.source, Load) else -1 for d in segment.delays]
        self._ints("state_of", np.array([numbers.get(slot, -1) for slot in slots], dtype=np.int64))
        self._ints("jump_at", np.zeros(count, dtype=np.int64))
        self._ints("found", np.zeros(count, dtype=np.int64))
        self._tau = np.zeros(count)
        self._reals("tau", self._tau)
        self._reals("spare", np.zeros(4))
        m.jump_room = _JUMPS
        self._reals("jumps", np.zeros(_JUMPS))
        self._ints("smoothness", np.zeros(_JUMPS, dtype=np.int64))
        self._remembered: list[np.ndarray[Any, np.dtype[np.float64]]] = []
        self._make_room(_ROOM)

    def _take_past(self, past: Past | None, t: float) -> None:
        """Go on with the histories of the run before up to t, if there are such; else begin anew."""
        m = self.moments
        old = None if past is None else past.stepper
        m.has_past = int(old is not None and old.delay_count == m.delay_count)
        if old is None or not m.has_past:
            self._remembered, m.knots = [], 0
            self._make_room(_ROOM)
        elif old is not self:
            self._adopt(old.remembered())
        if m.has_past:  # a run that is made once more finds what came later
            m.knots = int(np.searchsorted(self._remembered[0][: m.knots], t, side="right"))
            jumps = np.ctypeslib.as_array(m.jumps, (_JUMPS,))[: m.jump_count]
            m.jump_count = int(np.searchsorted(jumps, t, side="right"))
            for j in range(m.delay_count):
                m.jump_at[j] = min(m.jump_at[j], m.jump_count)

    @property
    def delay_count(self) -> int:
        """How many delays have a history."""
        return int(self.moments.delay_count)

    def remembered(self) -> Remembered:
        """Return a copy of the histories."""
        m = self.moments
        times, history, slopes = self._remembered
        knots = times[: m.knots].copy(), history[:, : m.knots].copy(), slopes[:, : m.knots].copy()
        jumps, smoothness, jump_at = (
            np.ctypeslib.as_array(getattr(m, name), (size,))[:size].copy()
            for name, size in (("jumps", _JUMPS), ("smoothness", _JUMPS), ("jump_at", m.delay_count))
        )
        return Remembered(knots, jumps[: m.jump_count], smoothness[: m.jump_count], jump_at)

    def _adopt(self, old: Remembered) -> None:
        """Go on with histories of another model, or of an earlier time."""
        m = self.moments
        self._remembered, m.knots = list(old.knots), len(old.knots[0])
        self._make_room(max(_ROOM, 2 * m.knots))
        m.jump_count = len(old.jumps)
        np.ctypeslib.as_array(m.jumps, (_JUMPS,))[: m.jump_count] = old.jumps
        np.ctypeslib.as_array(m.smoothness, (_JUMPS,))[: m.jump_count] = old.smoothness
        np.ctypeslib.as_array(m.jump_at, (m.delay_count,))[:] = old.jump_at

    def _make_room(self, room: int) -> None:
        m, count, knots = self.moments, self.moments.delay_count, self.moments.knots
        times, history, slopes = np.zeros(room), np.zeros((count, room)), np.zeros((count, room))
        if self._remembered and knots:
            old = self._remembered
            times[:knots] = old[0][:knots]
            history[:, :knots], slopes[:, :knots] = old[1][:, :knots], old[2][:, :knots]
        self._remembered = [times, history, slopes]
        for name, numbers in zip(("times", "history", "slopes"), self._remembered, strict=True):
            setattr(m, name, ctypes.cast(numbers.ctypes.data, ctypes.POINTER(ctypes.c_double)))
        m.room = room

    @property
    def step_start(self) -> tuple[int, int]:
        """Addresses of the states and derivatives at a step's start."""
        return self._x0.ctypes.data, self.k.ctypes.data

    def follow_series(self, conditions: Sequence[int]) -> None:
        """Tell the number of each condition's series among the solver's arguments (`along`)."""
        for number, argument in enumerate(conditions):
            self.moments.arguments[number] = argument

    def grow(self) -> None:
        """Make the room for histories twice as large."""
        self._make_room(2 * self.moments.room)

    def _rule(self, tableau: Tableau | None, order: int) -> None:
        m = self.moments
        stages = 0 if tableau is None else tableau.stages
        self.k = np.zeros(max(stages, 1) * order)
        self._reals("k", self.k)
        at = np.arange(max(stages, 1), dtype=np.uint64) * np.uint64(8 * order) + np.uint64(self.k.ctypes.data)
        self._keep("k_at", at, ctypes.c_uint64)
        m.stages = stages
        if tableau is None:
            return
        m.is_variable, m.dt_may_change = int(tableau.variable), int(tableau.rule.dt_may_change)
        self._reals("nodes", np.array([float(c) for c in tableau.c]))
        rows = [*tableau.a, tableau.b, *([] if tableau.test is None else [tableau.test])]
        table, denominators = np.zeros((len(rows), stages)), np.ones(len(rows))
        for place, row in enumerate(rows):
            if row:
                denominators[place], multiples = whole_multiples(row)
                table[place, : len(multiples)] = multiples
        self._reals("rows", table.reshape(-1))
        self._reals("denominators", denominators)

    def prepare(self, memory: Any, times: Sequence[tuple[float, float]], taus: Sequence[float]) -> None:
        """Prepare a run: its memory, period and start of each `every`, each delay; 0 for what varies."""
        m = self.moments
        if taus:
            self._tau[:] = taus
            m.tau_least = min((tau for tau in taus if tau > 0.0), default=0.0)
            self._take_past(memory.past if memory.joined else None, memory.t_start)
            memory.past.stepper = self
        m.goes_on = memory.joined
        m.memory = ctypes.addressof(memory)
        m.span = SPAN * memory.comint
        for number, (period, start) in enumerate(times):
            self._period[number], self._start[number] = period, start
            if period > 0.0:
                ticks = first_tick(period, start, memory.t_start)
                if memory.joined and abs(start + ticks * period - memory.t_start) <= _SAME * period:
                    ticks += 1.0  # that of the joint had its turn in the run before
                m.ticks[number], m.next[number] = ticks, start + ticks * period

    def _reals(self, name: str, numbers: np.ndarray[Any, np.dtype[np.float64]]) -> None:
        self._keep(name, numbers, ctypes.c_double)

    def _ints(self, name: str, numbers: np.ndarray[Any, np.dtype[np.int64]]) -> None:
        self._keep(name, numbers, ctypes.c_int64)

    def _keep(self, name: str, numbers: np.ndarray[Any, Any], kind: Any) -> None:
        self._kept.append(numbers)
        setattr(self.moments, name, ctypes.cast(numbers.ctypes.data, ctypes.POINTER(kind)))
