"""The variables of a loop over runs in lock step: counts that all runs share, flags for each run."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir.lanes import Lanes
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from desire_tui.engine.codegen.ir.work_memory import Fields
    from desire_tui.engine.codegen.lanes.lane_cells import LaneCells
    from desire_tui.engine.codegen.lanes.lane_statements import LaneStatements
    from desire_tui.engine.codegen.lanes.replicas import Replicas
    from desire_tui.engine.lowered.statements import Action

_SHARED = (
    ("k", "i64"),
    ("steps", "i64"),
    ("point", "i64"),
    ("row", "i64"),
    ("t_next", "double"),
    ("reached", "i1"),
)
"""Steps since the start, and so on: one number for all runs."""
_OF_EACH = ("alive", "fired", "flagged")
"""Flags: it goes on; a `term` has fired; it is to be made again alone."""


class LaneVariables:
    """Stack cells `%l.NAME`, the runs' memory, and what parts of the loop do with them."""

    def __init__(
        self,
        runs: Replicas,
        cells: LaneCells,
        memory: Fields,
        statements: LaneStatements,
        passes: Mapping[str, tuple[Action, ...]],
        *,
        may_end: bool,
    ) -> None:
        """`may_end`: single runs may end before the others."""
        self.text, self.one, self.runs = runs.text, Lanes(runs.text), runs
        self.cells, self.memory, self.statements, self.passes = cells, memory, statements, passes
        self.may_end = may_end

    def begin(self) -> None:
        """Write what makes the variables, all runs at their start."""
        text, runs = self.text, self.runs
        for name, kind in _SHARED:
            text.alloca(kind, f"%l.{name}")
        for name in _OF_EACH:
            text.alloca(runs.flags, f"%l.{name}")
        for name in ("random", "taken"):
            text.alloca(runs.integers, f"%l.{name}")
        for name in ("k", "steps", "point", "row"):
            self.put("i64", name, "0")
        self.put_flags("alive", "splat (i1 true)")
        self.put_flags("fired", "zeroinitializer")
        self.put_flags("flagged", "zeroinitializer")
        self.put(runs.integers, "taken", "zeroinitializer")
        self.put(runs.integers, "random", text.op(f"load {runs.integers}, ptr %seeds, align 8"))

    def get(self, kind: str, name: str) -> str:
        """Read a variable."""
        return self.text.op(f"load {kind}, ptr %l.{name}")

    def put(self, kind: str, name: str, value: str) -> None:
        """Set a variable."""
        self.text.do(f"store {kind} {value}, ptr %l.{name}")

    def flags(self, name: str) -> str:
        """Read flags."""
        return self.get(self.runs.flags, name)

    def put_flags(self, name: str, value: str) -> None:
        """Set flags."""
        self.put(self.runs.flags, name, value)

    def run_pass(self, kind: str, stage: int, mask: str | None = None) -> None:
        """Write a pass, for those runs that have their flag set."""
        self.cells.stage = stage
        self.statements.write(self.passes[kind], mask)

    def t(self) -> str:
        """Return the time."""
        return self.cells.load(T).name

    def clear_fired(self) -> None:
        """No `term` has fired."""
        if self.may_end:
            self.put_flags("fired", "zeroinitializer")

    def next_point(self) -> None:
        """Write when the next communication point is."""
        index = self.text.op(f"sitofp i64 {self.get('i64', 'point')} to double")
        span = self.one.mul(index, self.memory.load("comint"))
        self.put("double", "t_next", self.one.add(self.memory.load("t_start"), span))

    def freeze(self, which: str) -> None:
        """Let runs go on no more."""
        self.put_flags("alive", self.runs.but(self.flags("alive"), which))

    def flag(self, bad: str) -> None:
        """Note the runs that are to be made again alone, and let them go on no more."""
        bad = self.runs.both(bad, self.flags("alive"))
        self.put_flags("flagged", self.runs.either(self.flags("flagged"), bad))
        self.freeze(bad)

    def wild(self, slots: Sequence[int]) -> str:
        """Return the flags of runs with inf or nan in some slots.

        x - x is 0 for every finite x, and not a number else; so is the sum.
        """
        total = self.runs.const(0.0)
        for slot in slots:
            value = self.cells.wide(self.cells.load(slot))
            total = self.runs.add(total, self.runs.sub(value, value))
        return self.runs.compare("uno", total, total)
