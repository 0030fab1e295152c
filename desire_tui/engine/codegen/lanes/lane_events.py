"""`event` and `delay(x, tau)` for runs in lock step: whoever has something happen in a step makes it alone.

All runs try a whole step. Where the condition of an event has risen in it, or a clock or a jump is due, the
run is set back and takes the step as it would alone (`runtime.moments.side_by_side`), while the others wait.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.codegen.ir.work_memory import Fields
from desire_tui.engine.codegen.lanes.lane_cells import Number
from desire_tui.engine.runtime.moments.memory import SideBySide

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.codegen.lanes.lane_variables import LaneVariables


class EventSlots(NamedTuple):
    """A segment's events and delays.

    `conditions`: numbers of the events that have one, whose values stand at `now` + number. `delays` values
    are remembered, as they stand at `source` + number. `kept`: the slots that a step changes besides states.
    """

    conditions: Sequence[int]
    now: int
    delays: int
    source: int
    kept: Sequence[int]


class LaneEvents:
    """Writes what events and delays ask for; `states` are the states' slots."""

    def __init__(self, loop: LaneVariables, slots: EventSlots, states: Sequence[int]) -> None:
        self.loop, self.text, self.runs, self.cells = loop, loop.text, loop.runs, loop.cells
        self.slots, self._states = slots, states
        self.own = [slot for slot in self.cells.slots if slot in self.cells.differing]
        """Numbers of each run, in the order in which they are handed over."""
        self._side = Fields(self.text, SideBySide, "%side")

    def begin(self) -> None:
        """Write what comes before a run's first pass: what is due at its start."""
        text, runs, side = self.text, self.runs, self._side
        text.do(f"%side = load ptr, ptr {self.loop.memory.at('side')}")
        for number in self.slots.conditions:
            text.alloca(runs.kind, f"%l.before.{number}")
            for name in ("armed", "in_doubt"):
                text.alloca(runs.flags, f"%l.{name}.{number}")
        text.alloca(runs.kind, "%l.soon")
        for name in ("alone", "known"):
            text.alloca(runs.flags, f"%l.{name}")
        for slot in self.slots.kept:
            text.alloca(runs.kind, f"%l.kept.{slot}")
        text.alloca(runs.integers, "%l.kept.random")
        side.store("here", self.loop.t())
        side.store("k", "0")
        side.store("group", self.loop.memory.load("group"))
        self._hand_over(None)
        self._call("begin_runs")
        self._take_back()

    def save(self) -> None:
        """Keep what a step changes besides states."""
        for slot in self.slots.kept:
            self.loop.put(self.runs.kind, f"kept.{slot}", self.cells.load(slot).name)
        self.loop.put(self.runs.integers, "kept.random", self._random())

    def note_known(self, limit: str) -> None:
        """Note which runs have a clock or a jump due by the time `limit`."""
        runs = self.runs
        soon = runs.compare("ole", self.loop.get(runs.kind, "soon"), runs.splat(limit))
        self.loop.put_flags("known", runs.both(soon, self.loop.flags("alive")))

    def record(self) -> None:
        """Remember values at a step's start, of the runs that are not known to make the step alone."""
        if not self.slots.delays:
            return
        self.loop.run_pass("sources", 1)
        for number in range(self.slots.delays):
            value = self.cells.wide(self.cells.load(self.slots.source + number))
            self._store("sources", number, value)
        self._store_derivatives()
        self._side.store("here", self.loop.t())
        self._store_wanted(self._integers(self.loop.flags("known")))
        self._call("record_runs")
        self._flag_failed()

    def look(self) -> str:
        """Note which runs make the step alone, at whose end all stand; return an i1: some do."""
        runs, loop = self.runs, self.loop
        if self.slots.conditions:
            loop.run_pass("conditions", 1)
        alone = loop.flags("known")
        zero = runs.const(0.0)
        for number in self.slots.conditions:
            value, before = self._now(number), loop.get(runs.kind, f"before.{number}")
            above = runs.compare("ogt", value, zero)
            at = runs.both(runs.compare("oeq", value, zero), runs.compare("olt", before, zero))
            rises = runs.both(loop.flags(f"armed.{number}"), runs.either(above, at))
            doubt = runs.both(loop.flags(f"in_doubt.{number}"), above)
            alone = runs.either(alone, runs.either(rises, doubt))
        alone = runs.both(alone, loop.flags("alive"))
        loop.put_flags("alone", alone)
        return runs.any(alone)

    def step_alone(self, here: str, k: str) -> None:
        """Write the steps that runs make alone, from where the step began."""
        runs, loop, side = self.runs, self.loop, self._side
        alone = loop.flags("alone")
        side.store("here", here)
        side.store("k", k)
        self._hand_over(alone)
        self._store_derivatives()
        for number in self.slots.conditions:
            self._store("before", number, loop.get(runs.kind, f"before.{number}"))
            for name in ("armed", "in_doubt"):
                self._store(name, number, self._integers(loop.flags(f"{name}.{number}")))
        wanted = self._integers(alone)
        if self.slots.delays:  # the start of those that were not known has been recorded
            tried = runs.but(alone, loop.flags("known"))
            wanted = self.text.op(f"add {runs.integers} {wanted}, {self._integers(tried)}")
        self._store_wanted(wanted)
        self._call("step_runs")
        self._take_back()

    def note(self) -> None:
        """Take up the conditions of the runs in whose step nothing has happened."""
        runs, loop = self.runs, self.loop
        alone, zero = loop.flags("alone"), runs.const(0.0)
        for number in self.slots.conditions:
            value, before = self._now(number), loop.get(runs.kind, f"before.{number}")
            at = runs.both(runs.compare("oeq", value, zero), runs.compare("ogt", before, zero))
            below = runs.either(runs.compare("olt", value, zero), at)
            armed = runs.but(loop.flags(f"armed.{number}"), runs.compare("ogt", value, zero))
            for name, new in (("armed", runs.either(below, armed)), ("in_doubt", "zeroinitializer")):
                old = runs.both(loop.flags(f"{name}.{number}"), alone)
                loop.put_flags(f"{name}.{number}", runs.either(old, runs.but(new, alone)))
            loop.put(runs.kind, f"before.{number}", runs.choose(alone, before, value))

    # ------------------------------------------------------------------ memory

    def _now(self, number: int) -> str:
        return self.cells.wide(self.cells.load(self.slots.now + number))

    def _hand_over(self, alone: str | None) -> None:
        """Write the own numbers into memory; of runs that begin a step alone those at its start."""
        runs, cells = self.runs, self.cells
        saved = {slot: f"%x0.{number}" for number, slot in enumerate(self._states)}
        saved |= {slot: f"%l.kept.{slot}" for slot in self.slots.kept}
        for place, slot in enumerate(self.own):
            value = cells.load(slot).name
            if alone is not None and slot in saved:
                old = self.text.op(f"load {runs.kind}, ptr {saved[slot]}")
                value = runs.choose(alone, old, value)
            self._store("own", place, value)
        random = self._random()
        if alone is not None:
            old = self.text.op(f"load {runs.integers}, ptr %l.kept.random")
            random = self.text.op(
                f"select {runs.flags} {alone}, {runs.integers} {old}, {runs.integers} {random}"
            )
        self._store("random", 0, random)

    def _take_back(self) -> None:
        runs, loop = self.runs, self.loop
        for place, slot in enumerate(self.own):
            self.cells.store(slot, Number(self._load("own", place, runs.kind), wide=True))
        loop.put(runs.integers, "random", self._load("random", 0, runs.integers))
        for number in self.slots.conditions:
            loop.put(runs.kind, f"before.{number}", self._load("before", number, runs.kind))
            for name in ("armed", "in_doubt"):
                loop.put_flags(f"{name}.{number}", self._flags(self._load(name, number, runs.integers)))
        loop.put(runs.kind, "soon", self._load("soon", 0, runs.kind))
        self._flag_failed()

    def _store_derivatives(self) -> None:
        for number in range(len(self._states)):
            self._store("k1", number, self.cells.wide(self.cells.kept("k1", number)))

    def _store_wanted(self, wanted: str) -> None:
        self._store("wanted", 0, wanted)
        self._store("failed", 0, "zeroinitializer")

    def _flag_failed(self) -> None:
        self.loop.flag(self._flags(self._load("failed", 0, self.runs.integers)))

    def _random(self) -> str:
        return self.loop.get(self.runs.integers, "random")

    def _integers(self, flags: str) -> str:
        return self.text.op(f"zext {self.runs.flags} {flags} to {self.runs.integers}")

    def _flags(self, numbers: str) -> str:
        return self.text.op(f"icmp ne {self.runs.integers} {numbers}, zeroinitializer")

    def _at(self, name: str, place: int) -> str:
        array = self._side.load(name)
        return self.text.op(f"getelementptr double, ptr {array}, i64 {place * self.runs.width}")

    def _store(self, name: str, place: int, value: str) -> None:
        kind = self.runs.kind if name in _REALS else self.runs.integers
        self.text.do(f"store {kind} {value}, ptr {self._at(name, place)}, align 8")

    def _load(self, name: str, place: int, kind: str) -> str:
        return self.text.op(f"load {kind}, ptr {self._at(name, place)}, align 8")

    def _call(self, name: str) -> None:
        self.text.declarations.add(f"declare void @moments.{name}(ptr)")
        self.text.do(f"call void @moments.{name}(ptr %side)")


_REALS = frozenset(("own", "k1", "sources", "before"))
