"""Storage for small models of scalars: everything in stack cells that LLVM keeps in registers."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir.cells import RegisterCells
from desire_tui.engine.codegen.ir.lanes import Lanes
from desire_tui.engine.codegen.ir.work_memory import context_fields, memory_fields
from desire_tui.engine.codegen.loop.stage_sums import scaled, weighted
from desire_tui.engine.codegen.scalar.slot_usage import survey
from desire_tui.engine.codegen.scalar.statements import ScalarStatements
from desire_tui.engine.values import DT, ERRMAX, T

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from desire_tui.engine.codegen.ir.text import IrText
    from desire_tui.engine.codegen.loop.looks import Glance, Looks
    from desire_tui.engine.integration.tableaus import Row
    from desire_tui.engine.lowered.statements import Action

_BOX = ("box_low", "box_high", "box_wait")
"""Where the sides of the box are in which no mode switches, and the steps until it may be made again."""


class RegisterStorage:
    """Implements `storage.Storage`; passes are written in line."""

    def __init__(
        self,
        text: IrText,
        passes: Mapping[str, tuple[Action, ...]],
        states: list[int],
        columns: list[int],
        vital: list[int],
        stages: int,
        looks: Looks,
    ) -> None:
        self.text = text
        self.looks, self._sides = looks.at, looks.sides
        self.passes = passes
        self.may_come_late = bool(passes["step_renewal"])
        self.states = states
        self.columns = columns
        self.vital = vital
        self.stages = stages
        self.lanes = Lanes(text)
        self.memory = memory_fields(text)
        self.context = context_fields(text)
        usage = survey(passes.values())
        self._changed = sorted((usage.written | {T, DT, ERRMAX, *states}) - usage.pinned - looks.scratch)
        slots = usage.read | usage.written | {T, DT, ERRMAX, *states, *columns}
        slots |= set(looks.sides)
        slots |= {slot for glances in looks.at.values() for _, *pair in glances for slot in pair}
        self.cells = RegisterCells(text, slots, usage.pinned)
        self.statements = ScalarStatements(text, self.cells)
        for number in range(len(states)):
            text.alloca("double", f"%x0.{number}")
            for stage in range(1, stages + 1):
                text.alloca("double", f"%k{stage}.{number}")

    # ------------------------------------------------------------------ coming and going

    def enter(self) -> None:
        """Read every cell from the values."""
        text = self.text
        text.do(f"%v = load ptr, ptr {self.memory.at('values')}")
        text.do(f"%random = load ptr, ptr {self.memory.at('random')}")
        for name in _BOX if self.has_box else ():
            self.context.name(f"%{name}", name)
        self.cells.fetch()

    def refresh(self) -> None:
        """Read every cell anew."""
        self.cells.fetch()

    def leave(self) -> None:
        """Write every cell that the run can change."""
        self.cells.flush(self._changed)

    def load(self, slot: int) -> str:
        """Read a scalar."""
        return self.cells.load(slot)

    def store(self, slot: int, value: str) -> None:
        """Write a scalar."""
        self.cells.store(slot, value)

    # ------------------------------------------------------------------ passes and steps

    def run_pass(self, kind: str, stage: int) -> None:
        """Write the pass in line."""
        self.cells.prefix = f"%k{stage}"
        self.statements.write(self.passes[kind])

    def _k(self, stage: int, state: int) -> str:
        return self.text.op(f"load double, ptr %k{stage}.{state}")

    def _x0(self, state: int) -> str:
        return self.text.op(f"load double, ptr %x0.{state}")

    def save(self) -> None:
        """Keep the states at a step's start."""
        for number, slot in enumerate(self.states):
            self.text.do(f"store double {self.cells.load(slot)}, ptr %x0.{number}")

    def advance(self, row: Row, dt: str, *, saves: bool = False) -> None:
        """States ← saved states + dt·Σ row·k."""
        if saves:
            self.save()
        factor = scaled(self.lanes, row, dt)
        for number, slot in enumerate(self.states):
            total = weighted(self.lanes, row, lambda stage, n=number: self._k(stage, n))  # type: ignore[misc]  # n=: bound now
            self.cells.store(slot, self.lanes.add(self._x0(number), self.lanes.mul(factor, total)))

    def whole_step(self) -> str:
        """Return nothing: all stages are in this function."""
        return ""

    def restore(self) -> None:
        """States ← saved states."""
        for number, slot in enumerate(self.states):
            self.cells.store(slot, self._x0(number))

    def difference(self, row: Row, dt: str) -> tuple[str, str]:
        """Largest test difference and its state."""
        lanes, text = self.lanes, self.text
        factor = scaled(lanes, row, dt)
        checked = self.memory.load("checked")
        relative = text.op(f"icmp eq i64 {checked}, 0")
        one_more = self.memory.load("error_one")
        most, where = lanes.const(0.0), "0"
        for number in range(len(self.states)):
            total = weighted(lanes, row, lambda stage, n=number: self._k(stage, n))  # type: ignore[misc]  # n=: bound now
            absolute = lanes.mul(factor, lanes.intrinsic("fabs", total))
            size = lanes.add(lanes.intrinsic("fabs", self._x0(number)), one_more)
            mine = text.op(f"icmp eq i64 {checked}, {number + 1}")
            own = lanes.choose(mine, absolute, lanes.const(0.0))
            value = lanes.choose(relative, lanes.div(absolute, size), own)
            larger = lanes.compare("ogt", value, most)
            most = lanes.choose(larger, value, most)
            where = text.op(f"select i1 {larger}, i64 {number}, i64 {where}")
        return most, where

    # ------------------------------------------------------------------ looking

    def _is_wild(self, values: list[str]) -> str:
        """X - x is 0 for every finite x, and not a number else; so is the sum."""
        total = self.lanes.const(0.0)
        for value in values:
            total = self.lanes.add(total, self.lanes.sub(value, value))
        return self.lanes.compare("uno", total, total)

    def wild(self) -> str:
        """Whether some state is inf or nan."""
        return self._is_wild([self.cells.load(slot) for slot in self.states])

    def width(self) -> str:
        """Doubles in a row."""
        return str(1 + len(self.columns))

    def row(self, at: str, t: str) -> str:
        """Write t and the columns."""
        self.text.do(f"store double {t}, ptr {at}")
        values = [self.cells.load(slot) for slot in self.columns]
        for number, value in enumerate(values, 1):
            place = self.text.op(f"getelementptr double, ptr {at}, i64 {number}")
            self.text.do(f"store double {value}, ptr {place}")
        return self._is_wild(values)

    def vital_wild(self) -> str:
        """Whether some column that states depend on is inf or nan."""
        return self._is_wild([self.cells.load(slot) for slot in self.vital])

    def has_pass(self, kind: str) -> str:
        """Whether the pass has any statement."""
        return "1" if self.passes[kind] else "0"

    def keep_change(self) -> None:
        """k2 ← k1."""
        for number in range(len(self.states)):
            self.text.do(f"store double {self._k(1, number)}, ptr %k2.{number}")

    def switched(self, kind: str) -> str:
        """Whether some mode may have switched."""
        found = "0"
        for look in self.looks[kind]:
            found = self.text.op(f"or i1 {found}, {self._look(*look)}")
        return found

    @property
    def has_box(self) -> bool:
        """Whether modes depend on t or states."""
        return bool(self._sides)

    def is_in_box(self, *, at_end: bool) -> str:
        """Whether t and states are inside; at a stage, t is between the step's ends."""
        lanes, text, inside = self.lanes, self.text, "1"
        for name, compare in (("box_low", "oge"), ("box_high", "ole")):
            for number, slot in enumerate(self._sides):
                if slot != T or at_end:
                    at = text.op(f"getelementptr double, ptr %{name}, i64 {number}")
                    held = lanes.compare(compare, self.cells.load(slot), text.op(f"load double, ptr {at}"))
                    inside = text.op(f"and i1 {inside}, {held}")
        return inside

    def _look(self, kind: Glance, slot: int, frozen: int) -> str:
        lanes, zero = self.lanes, self.lanes.const(0.0)
        value = self.cells.load(slot)
        if kind == "margin":
            return lanes.compare("ult", value, zero)
        now = self.cells.load(frozen)
        if kind == "differs":
            return lanes.compare("une", value, now)
        sides = [lanes.compare("ogt", each, zero) for each in (value, now)]
        return self.text.op(f"xor i1 {sides[0]}, {sides[1]}")

    def keep_first_stage(self) -> None:
        """Put k1 into the context's array."""
        self._keep("k1", lambda number: self._k(1, number))

    def keep_start(self) -> None:
        """Put x0 into the context's array."""
        self._keep("x0", self._x0)

    def _keep(self, name: str, value: Callable[[int], str]) -> None:
        base = self.context.load(name)
        for number in range(len(self.states)):
            at = self.text.op(f"getelementptr double, ptr {base}, i64 {number}")
            self.text.do(f"store double {value(number)}, ptr {at}")

    def recall_first_stage(self) -> None:
        """Get k1 from there."""
        base = self.context.load("k1")
        for number in range(len(self.states)):
            at = self.text.op(f"getelementptr double, ptr {base}, i64 {number}")
            self.text.do(f"store double {self.text.op(f'load double, ptr {at}')}, ptr %k1.{number}")
