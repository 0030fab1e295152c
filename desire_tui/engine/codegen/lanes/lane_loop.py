"""The run loop of `loop.run_loop` for runs in lock step under a rule with fixed steps.

All runs have the same times, so there is one t, one count of steps, one way through the loop. A run that has
ended is frozen: its samples are no longer written. One in which something irregular shows (an inf or nan in a
state, a fault) is flagged: whoever called makes that run again alone, for its message.

    point  ── full pass, sample ──► step                   (a communication point)
    again  ── step pass; `term`? tail pass, sample ──► step
    step   ── the rule: stages, new states, t ──► attend where something is to be looked at, else again
    attend ── stop flag, inf and nan ──► point or again
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.codegen.ir.symbols import sine_and_cosine
from desire_tui.engine.codegen.ir.text import IrText
from desire_tui.engine.codegen.ir.work_memory import Fields
from desire_tui.engine.codegen.jit.piece import Piece
from desire_tui.engine.codegen.lanes.event_steps import EventSteps
from desire_tui.engine.codegen.lanes.lane_cells import LaneCells, Number
from desire_tui.engine.codegen.lanes.lane_clocks import ClockedSteps, ClockSlots, LaneClocks
from desire_tui.engine.codegen.lanes.lane_events import EventSlots, LaneEvents
from desire_tui.engine.codegen.lanes.lane_expressions import LaneExpressions
from desire_tui.engine.codegen.lanes.lane_folds import LaneFolds
from desire_tui.engine.codegen.lanes.lane_frame import LaneMemory, lane_frame
from desire_tui.engine.codegen.lanes.lane_histories import LaneHistories
from desire_tui.engine.codegen.lanes.lane_points import LanePoints
from desire_tui.engine.codegen.lanes.lane_statements import LaneStatements
from desire_tui.engine.codegen.lanes.lane_steps import LaneSteps
from desire_tui.engine.codegen.lanes.lane_variables import LaneVariables
from desire_tui.engine.codegen.lanes.replicas import Replicas
from desire_tui.engine.codegen.lanes.shared_values import SharedValues
from desire_tui.engine.codegen.scalar.slot_usage import survey
from desire_tui.engine.digest import blake2b
from desire_tui.engine.lowered.effects import expressions
from desire_tui.engine.lowered.expressions import Op
from desire_tui.engine.lowered.walk import walk_actions, walk_values
from desire_tui.engine.passes.final_sample import holds_term
from desire_tui.engine.runtime.moments.steps import SLACK
from desire_tui.engine.values import DT, T

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from desire_tui.engine.integration.tableaus import Tableau
    from desire_tui.engine.lowered.statements import Action


class LaneParts(NamedTuple):
    """What a loop is written from."""

    passes: Mapping[str, tuple[Action, ...]]
    tableau: Tableau | None
    """None: rule 0, no steps."""
    states: Sequence[int]
    columns: Sequence[int]
    folds: Sequence[str]
    """What is kept of each column (`lane_folds`); none: all samples are."""
    vital: Sequence[int]
    given: Sequence[int]
    """Slots with a start for each run."""
    differing: frozenset[int]
    faults: frozenset[int]
    arrays: Mapping[int, int]
    """Lengths of stored histories by their first slots."""
    counters: int
    over_elements: frozenset[int]
    moments: ClockSlots | EventSlots | None
    """What happens at moments of all runs, or at those of each run's own."""


class LaneLoop:
    """Writes the function `i32 NAME(ptr LaneMemory)`.

    `width` runs go side by side; functions of the library are called with vectors of `piece` doubles.
    """

    def __init__(self, parts: LaneParts, width: int, piece: int) -> None:
        self.text = IrText()
        passes, tableau, states = parts.passes, parts.tableau, parts.states
        together = sine_and_cosine() is not None and _takes_both(passes["derivative"])
        self.runs = Replicas(self.text, width, piece, together=together)
        usage = survey(passes.values())
        stages = tableau.stages if tableau is not None else 0
        slots = usage.read | usage.written | {T, DT, *states, *parts.columns, *parts.vital}
        self.cells = LaneCells(self.text, self.runs, slots, parts.differing, states, stages)
        self.memory = Fields(self.text, LaneMemory, "%a")
        self.histories = LaneHistories(self.runs, self.cells, self.memory, parts.arrays, parts.counters)
        self.shared = SharedValues(self.text, "point" if tableau is None else "k")
        values = LaneExpressions(self.runs, self.cells, parts.over_elements, self.shared)
        self.statements = LaneStatements(self.runs, self.cells, parts.faults, self.histories, values)
        may_end = holds_term(passes["step"]) or holds_term(passes["full"])
        self.loop = LaneVariables(
            self.runs, self.cells, self.memory, self.statements, passes, may_end=may_end
        )
        self.folds = LaneFolds(self.loop, parts.columns, parts.folds) if parts.folds else None
        self.points = LanePoints(self.loop, parts.columns, parts.vital, self.folds, steps=tableau is not None)
        self.clocks = self.events = None
        if isinstance(parts.moments, ClockSlots):
            self.clocks = LaneClocks(self.loop, parts.moments)
        elif parts.moments is not None:
            self.events = LaneEvents(self.loop, parts.moments, states)
        self.steps = None if tableau is None else self._steps(tableau, states)
        self.given = parts.given

    def _steps(self, tableau: Tableau, states: Sequence[int]) -> LaneSteps:
        if self.events is not None:
            return EventSteps(self.loop, self.points, tableau, states, self.events)
        if self.clocks is not None:
            return ClockedSteps(self.loop, self.points, tableau, states, self.clocks)
        return LaneSteps(self.loop, self.points, tableau, states)

    @property
    def own(self) -> Sequence[int]:
        """The slots of what single runs are handed over by."""
        return self.events.own if self.events is not None else ()

    def piece(self) -> Piece:
        """Return the code, named by its content."""
        self._write()
        width = self.runs.width
        body = self.text.body()
        whole = "\n".join((body, *sorted(self.text.declarations)))  # what it calls depends on `piece`
        name = "l" + blake2b(whole.encode(), digest_size=10).hexdigest()
        frame = lane_frame(
            name,
            width=width,
            given=len(self.given),
            elements=self.histories.elements,
        )
        group = (
            f"define internal i32 @{name}.group(ptr %a, ptr noalias %v, ptr noalias %in, ptr noalias %seeds,"
            f" ptr noalias %rows, ptr noalias %arrays, ptr noalias %counts, ptr noalias %flags,"
            f" ptr noalias %shared, i64 %kept) #0"
            f" {{\n{body}\n}}"
        )
        return Piece(name, f"{group}\n{frame}", frozenset(self.text.declarations))

    def _write(self) -> None:
        self.loop.begin()
        self.text.do(f"%base = load ptr, ptr {self.memory.at('base')}")
        self.cells.fetch(self.given)
        self.histories.begin()
        if self.folds is not None:
            self.folds.begin()
        if self.clocks is not None:
            self.clocks.begin()
        if self.events is not None:
            self.events.begin()
        self.loop.next_point()
        self.text.jump("point")
        self.points.write()
        if self.steps is None:
            self._next_without_rule()
        else:
            self.steps.write()
        self._exit()

    def _next_without_rule(self) -> None:
        self.text.begin("step")
        self.cells.store(T, Number(self.loop.get("double", "t_next"), wide=False))
        if self.clocks is not None:
            one = self.loop.one
            self.clocks.arrive(one.mul(one.const(SLACK), self.memory.load("comint")))
        stop = self.text.op(f"icmp ne i64 {self.memory.load('stop', volatile=True)}, 0")
        self.text.branch(stop, "exit", "point")

    def _exit(self) -> None:
        text, runs = self.text, self.runs
        text.begin("exit")
        if self.folds is not None:
            self.folds.finish()
        text.do(f"store {runs.integers} {self.loop.get(runs.integers, 'taken')}, ptr %counts, align 8")
        flags = text.op(f"zext {runs.flags} {self.loop.flags('flagged')} to {runs.integers}")
        text.do(f"store {runs.integers} {flags}, ptr %flags, align 8")
        text.do("ret i32 0")


def _takes_both(actions: Iterable[Action]) -> bool:
    """Whether statements take sine and cosine of the same expression."""
    taken: dict[str, set[str]] = {"sin": set(), "cos": set()}
    for action in walk_actions(actions):
        for node in walk_values(*expressions(action)):
            if isinstance(node, Op) and node.name in taken:
                taken[node.name].add(repr(node.args))
    return not taken["sin"].isdisjoint(taken["cos"])
