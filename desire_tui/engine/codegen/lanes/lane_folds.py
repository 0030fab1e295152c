"""Numbers kept of runs in lock step, computed while samples come: no sample has to be stored.

The operations and their order are those of `studies.reductions`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.values import T

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.codegen.lanes.lane_variables import LaneVariables

FOLDS = frozenset(("first", "last", "max", "min", "mean", "integral", "when"))
"""What can be kept so."""
_BEGIN = {"max": float("-inf"), "min": float("inf"), "when": float("nan")}


class LaneFolds:
    """Writes how the number of each of some `columns` grows: its kind is that of `kinds`."""

    def __init__(self, loop: LaneVariables, columns: Sequence[int], kinds: Sequence[str]) -> None:
        self.loop, self.text, self.runs, self.cells = loop, loop.text, loop.runs, loop.cells
        self._columns, self._kinds = columns, kinds

    def begin(self) -> None:
        """Write what comes before the first sample."""
        kind = self.runs.kind
        for number, name in enumerate(self._kinds):
            self.text.alloca(kind, f"%l.fold.{number}")
            self.text.alloca(kind, f"%l.before.fold.{number}")
            self.loop.put(kind, f"fold.{number}", self.runs.const(_BEGIN.get(name, 0.0)))
        self.text.alloca(kind, "%l.before.t")

    def sample(self, mask: str) -> None:
        """Take up a sample of the runs that have their flag set."""
        runs, loop = self.runs, self.loop
        taken = loop.get(runs.integers, "taken")
        is_first, is_second = (
            self.text.op(f"icmp eq {runs.integers} {taken}, {runs.integer(number)}") for number in (0, 1)
        )
        t = self.cells.wide(self.cells.load(T))
        for number, (slot, kind) in enumerate(zip(self._columns, self._kinds, strict=True)):
            value = self.cells.wide(self.cells.load(slot))
            old = loop.get(runs.kind, f"fold.{number}")
            match kind:
                case "first":
                    new = runs.choose(is_first, value, old)
                case "max" | "min":
                    better = runs.compare("ogt" if kind == "max" else "olt", value, old)
                    new = runs.choose(runs.either(better, runs.compare("uno", value, value)), value, old)
                case "mean":
                    new = runs.choose(is_first, value, runs.add(old, value))
                case "integral":
                    area = self._area(number, value, t, mask)
                    grown = runs.choose(is_second, area, runs.add(old, area))
                    new = runs.choose(is_first, old, grown)
                case "when":
                    holds = runs.compare("ogt", value, runs.const(0.0))
                    new = runs.choose(runs.both(holds, runs.compare("uno", old, old)), t, old)
                case _:
                    new = value
            loop.put(runs.kind, f"fold.{number}", runs.choose(mask, new, old))
        if "integral" in self._kinds:
            loop.put(runs.kind, "before.t", runs.choose(mask, t, loop.get(runs.kind, "before.t")))

    def _area(self, number: int, value: str, t: str, mask: str) -> str:
        """Return the area under the straight line from the sample before; the next one begins here."""
        runs, loop = self.runs, self.loop
        before = loop.get(runs.kind, f"before.fold.{number}")
        width = runs.sub(t, loop.get(runs.kind, "before.t"))
        loop.put(runs.kind, f"before.fold.{number}", runs.choose(mask, value, before))
        return runs.mul(runs.mul(runs.const(0.5), runs.add(value, before)), width)

    def finish(self) -> None:
        """Write the numbers to `%rows`: (columns, runs)."""
        text, runs, loop = self.text, self.runs, self.loop
        count = loop.memory.load("runs")
        for number, kind in enumerate(self._kinds):
            value = loop.get(runs.kind, f"fold.{number}")
            if kind == "mean":
                taken = loop.get(runs.integers, "taken")
                value = runs.div(value, text.op(f"sitofp {runs.integers} {taken} to {runs.kind}"))
            place = text.op(f"getelementptr double, ptr %rows, i64 {text.op(f'mul i64 {count}, {number}')}")
            text.do(f"store {runs.kind} {value}, ptr {place}, align 8")
