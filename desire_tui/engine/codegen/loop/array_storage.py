"""Storage for models of any size: states and derivatives in arrays, passes as tables of compiled pieces.

Nothing here depends on the model but whether its states stand side by side, so one compiled loop serves all
models of a rule.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir.counted_loops import elementwise, fetch, loop, put
from desire_tui.engine.codegen.ir.lanes import Lanes
from desire_tui.engine.codegen.ir.work_memory import context_fields, memory_fields
from desire_tui.engine.codegen.loop.stage_sums import scaled, weighted
from desire_tui.engine.codegen.pieces.pass_functions import call_table

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.codegen.ir.text import IrText
    from desire_tui.engine.codegen.ir.work_memory import Fields
    from desire_tui.engine.integration.tableaus import Row

    Visit = Callable[[Lanes, str, str, str, str], None]


class ArrayStorage:
    """Implements `storage.Storage`. `contiguous`: the states stand side by side in the values.

    Loops run over the states from number `first` to before `end`.
    """

    first, end = "0", "%n"
    saves_on_the_way = False
    """Whether the loop of a step's first stage saves the states too: a gain where no cache holds them."""

    may_come_late = True
    """Known when it runs."""

    def __init__(self, text: IrText, stages: int, width: int, *, contiguous: bool) -> None:
        self.text = text
        self.stages = stages
        self.vector = width if contiguous else 1
        self.contiguous = contiguous
        self.lanes = Lanes(text)
        self.memory = memory_fields(text)
        self.context = context_fields(text)

    # ------------------------------------------------------------------ coming and going

    def enter(self) -> None:
        """Name the arrays."""
        names = {"v": "values", "slots": "state_slots", "columns": "columns", "n": "states"}
        for name, field in (names | {"column.count": "column_count"}).items():
            self.context.name(f"%{name}", field)
        self.name_vectors(self.context)

    def name_vectors(self, context: Fields) -> None:
        """Name the arrays with an element for each state."""
        for name in ("x", "x0", *(f"k{stage}" for stage in range(1, max(self.stages, 1) + 1))):
            context.name(f"%{name}", name)

    def leave(self) -> None:
        """Everything is in memory all the time."""

    def refresh(self) -> None:
        """Nothing to do: it is read when it is wanted."""

    def load(self, slot: int) -> str:
        """Read a scalar."""
        return self.text.op(f"load double, ptr {self._at(slot)}")

    def store(self, slot: int, value: str) -> None:
        """Write a scalar."""
        self.text.do(f"store double {value}, ptr {self._at(slot)}")

    def _at(self, slot: int) -> str:
        return self.text.op(f"getelementptr double, ptr %v, i64 {slot}")

    # ------------------------------------------------------------------ passes and steps

    def run_pass(self, kind: str, stage: int) -> None:
        """Call the pieces of a pass one after the other."""
        call_table(self.text, self.context.load(kind), f"%k{stage}")

    def _states(self, body: Visit, factor: str = "") -> None:
        """Write a loop over the states: `body(lanes, number, base, index, factor)`, x at base[index]."""
        if self.contiguous:
            elementwise(
                self.text, self.end, self.vector, lambda lanes, i: body(lanes, i, "%x", i, factor), self.first
            )
            return

        def one(i: str) -> None:
            at = self.text.op(f"getelementptr i64, ptr %slots, i64 {i}")
            body(self.lanes, i, "%v", self.text.op(f"load i64, ptr {at}"), factor)

        loop(self.text, self.first, self.end, 1, one)

    def save(self) -> None:
        """Keep the states at a step's start."""
        self._states(lambda lanes, i, base, at, _: put(lanes, "%x0", i, fetch(lanes, base, at)))

    def advance(self, row: Row, dt: str, *, saves: bool = False) -> None:
        """States ← saved states + dt·Σ row·k."""
        on_the_way = saves and self.saves_on_the_way
        if saves and not on_the_way:
            self.save()

        def one(lanes: Lanes, i: str, base: str, at: str, factor: str) -> None:
            before = fetch(lanes, base, at) if on_the_way else fetch(lanes, "%x0", i)
            if on_the_way:
                put(lanes, "%x0", i, before)
            total = weighted(lanes, row, lambda stage: fetch(lanes, f"%k{stage}", i))
            put(lanes, base, at, lanes.add(before, lanes.mul(lanes.splat(factor), total)))

        self._states(one, scaled(self.lanes, row, dt))

    def whole_step(self) -> str:
        """Read it: models of replicas have one as soon as it is compiled."""
        return self.context.load("whole_step")

    def restore(self) -> None:
        """States ← saved states."""
        self._states(lambda lanes, i, base, at, _: put(lanes, base, at, fetch(lanes, "%x0", i)))

    def difference(self, row: Row, dt: str) -> tuple[str, str]:
        """Largest test difference and its state."""
        lanes, text = self.lanes, self.text
        factor = scaled(lanes, row, dt)
        most, where = text.alloca("double"), text.alloca("i64")
        text.do(f"store double 0.0, ptr {most}")
        text.do(f"store i64 0, ptr {where}")
        checked = text.op(f"add i64 {self.memory.load('checked')}, -1")
        relative = text.op(f"icmp slt i64 {checked}, 0")
        one_more = self.memory.load("error_one")

        def one(i: str) -> None:
            total = weighted(lanes, row, lambda stage: fetch(lanes, f"%k{stage}", i))
            absolute = lanes.mul(factor, lanes.intrinsic("fabs", total))
            size = lanes.add(lanes.intrinsic("fabs", fetch(lanes, "%x0", i)), one_more)
            mine = text.op(f"icmp eq i64 {checked}, {i}")
            own = lanes.choose(mine, absolute, lanes.const(0.0))
            value = lanes.choose(relative, lanes.div(absolute, size), own)
            before = text.op(f"load double, ptr {most}")
            larger = lanes.compare("ogt", value, before)
            text.do(f"store double {lanes.choose(larger, value, before)}, ptr {most}")
            place = text.op(f"load i64, ptr {where}")
            text.do(f"store i64 {text.op(f'select i1 {larger}, i64 {i}, i64 {place}')}, ptr {where}")

        loop(text, self.first, self.end, 1, one)
        return text.op(f"load double, ptr {most}"), text.op(f"load i64, ptr {where}")

    # ------------------------------------------------------------------ looking

    def wild(self) -> str:
        """Whether some state is inf or nan: the sum is no number then."""
        total = self.wildness()
        return self.lanes.compare("uno", total, total)

    def wildness(self) -> str:
        """Return the sum of x - x, 0 for every finite x."""
        wide, single = Lanes(self.text, self.vector), self.lanes
        sums = {lanes.width: self.text.alloca(lanes.kind) for lanes in (wide, single)}
        for lanes in (wide, single):
            self.text.do(f"store {lanes.kind} zeroinitializer, ptr {sums[lanes.width]}")

        def one(lanes: Lanes, _i: str, base: str, at: str, _factor: str) -> None:
            x = fetch(lanes, base, at)
            before = self.text.op(f"load {lanes.kind}, ptr {sums[lanes.width]}")
            total = lanes.add(before, lanes.sub(x, x))
            self.text.do(f"store {lanes.kind} {total}, ptr {sums[lanes.width]}")

        self._states(one)
        total = self.text.op(f"load double, ptr {sums[1]}")
        if self.vector > 1:
            parts = self.text.op(f"load {wide.kind}, ptr {sums[self.vector]}")
            for lane in range(self.vector):
                total = single.add(total, self.text.op(f"extractelement {wide.kind} {parts}, i64 {lane}"))
        return total

    def width(self) -> str:
        """Doubles in a row."""
        return self.text.op("add i64 %column.count, 1")

    def row(self, at: str, t: str) -> str:
        """Write t and the columns."""
        text = self.text
        text.do(f"store double {t}, ptr {at}")
        rest = text.op(f"getelementptr double, ptr {at}, i64 1")
        return self._any_wild("%columns", "%column.count", lambda i, value: put(self.lanes, rest, i, value))

    def vital_wild(self) -> str:
        """Whether some column that states depend on is inf or nan."""
        slots, count = self.context.load("vital"), self.context.load("vital_count")
        return self._any_wild(slots, count, lambda _i, _value: None)

    def _any_wild(self, slots: str, count: str, use: Callable[[str, str], object]) -> str:
        """Visit the numbers at `count` slots; return an i1: some of them is inf or nan."""
        text, lanes = self.text, self.lanes
        total = text.alloca("double")
        text.do(f"store double 0.0, ptr {total}")

        def one(i: str) -> None:
            slot = text.op(f"load i64, ptr {text.op(f'getelementptr i64, ptr {slots}, i64 {i}')}")
            value = fetch(lanes, "%v", slot)
            use(i, value)
            before = text.op(f"load double, ptr {total}")
            text.do(f"store double {lanes.add(before, lanes.sub(value, value))}, ptr {total}")

        loop(text, "0", count, 1, one)
        all_in_all = text.op(f"load double, ptr {total}")
        return lanes.compare("uno", all_in_all, all_in_all)

    def has_pass(self, kind: str) -> str:
        """Whether the pass has any piece."""
        first = self.text.op(f"load volatile ptr, ptr {self.context.load(kind)}")
        return self.text.op(f"icmp ne ptr {first}, null")

    def keep_change(self) -> None:
        """k2 ← k1."""
        elementwise(
            self.text,
            self.end,
            self.vector,
            lambda lanes, i: put(lanes, "%k2", i, fetch(lanes, "%k1", i)),
            self.first,
        )

    def switched(self, kind: str) -> str:
        """Whether some mode may have switched: all rows are looked at at the end."""
        text = self.text
        if kind == "watch_stage":
            return "0"
        frozen, first, second = (self.context.load(f"modes_{row}") for row in ("frozen", "first", "second"))
        found = text.alloca("i1")
        text.do(f"store i1 0, ptr {found}")

        def one(i: str) -> None:
            now = fetch(self.lanes, frozen, i)
            differ = [self.lanes.compare("une", fetch(self.lanes, row, i), now) for row in (first, second)]
            before = text.op(f"load i1, ptr {found}")
            either = text.op(f"or i1 {differ[0]}, {differ[1]}")
            text.do(f"store i1 {text.op(f'or i1 {before}, {either}')}, ptr {found}")

        loop(text, "0", self.context.load("mode_count"), 1, one)
        return text.op(f"load i1, ptr {found}")

    @property
    def has_box(self) -> bool:
        """One loop for all models knows no box of theirs."""
        return False

    def is_in_box(self, *, at_end: bool) -> str:  # noqa: ARG002 - as others are asked
        """No."""
        return "0"

    def keep_first_stage(self) -> None:
        """k1 stays in its array."""

    def keep_start(self) -> None:
        """x0 stays in its array."""

    def recall_first_stage(self) -> None:
        """Nothing to do: it is there."""
