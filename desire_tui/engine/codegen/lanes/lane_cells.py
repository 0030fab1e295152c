"""Where numbers are while runs go in lock step: stack cells, one number for all runs or one for each."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from desire_tui.engine.codegen.ir.text import IrText
    from desire_tui.engine.codegen.lanes.replicas import Replicas


class Number(NamedTuple):
    """A value's name; `wide`: it is a vector, a number for each run."""

    name: str
    wide: bool


class LaneCells:
    """Scalars by slot; those in `differing` are wide. LLVM promotes the cells to registers."""

    def __init__(
        self,
        text: IrText,
        runs: Replicas,
        slots: Iterable[int],
        differing: frozenset[int],
        states: Sequence[int],
        stages: int,
    ) -> None:
        self.text, self.runs = text, runs
        self.slots = sorted(set(slots))
        self.differing = differing
        self.states = states
        self.stage = 1
        for slot in self.slots:
            text.alloca(self._kind(slot), f"%s{slot}")
        for number, slot in enumerate(states):
            for name in ("x0", *(f"k{stage}" for stage in range(1, stages + 1))):
                text.alloca(self._kind(slot), f"%{name}.{number}")

    def _kind(self, slot: int) -> str:
        return self.runs.kind if slot in self.differing else "double"

    def load(self, slot: int) -> Number:
        """Read a scalar."""
        return Number(self.text.op(f"load {self._kind(slot)}, ptr %s{slot}"), slot in self.differing)

    def store(self, slot: int, value: Number, mask: str | None = None) -> None:
        """Write a scalar, for those runs that have their flag set."""
        if slot not in self.differing:
            assert not value.wide
            assert mask is None
            self.text.do(f"store double {value.name}, ptr %s{slot}")
            return
        name = self.wide(value)
        if mask is not None:
            name = self.runs.choose(mask, name, self.load(slot).name)
        self.text.do(f"store {self.runs.kind} {name}, ptr %s{slot}")

    def wide(self, value: Number) -> str:
        """Return a value as a vector."""
        return value.name if value.wide else self.runs.splat(value.name)

    def keep(self, name: str, state: int, value: Number) -> None:
        """Write a state's `x0` or one of its derivatives."""
        slot = self.states[state]
        named = self.wide(value) if slot in self.differing else value.name
        self.text.do(f"store {self._kind(slot)} {named}, ptr %{name}.{state}")

    def kept(self, name: str, state: int) -> Number:
        """Read it."""
        slot = self.states[state]
        found = self.text.op(f"load {self._kind(slot)}, ptr %{name}.{state}")
        return Number(found, slot in self.differing)

    def fetch(self, given: Sequence[int]) -> None:
        """Read every number from `%base`; those `given` for each run from `%in`."""
        places = {slot: place for place, slot in enumerate(given)}
        for number, slot in enumerate(self.slots):
            if slot in places:
                at = self.text.op(f"getelementptr double, ptr %in, i64 {places[slot] * self.runs.width}")
                value = Number(self.text.op(f"load {self.runs.kind}, ptr {at}, align 8"), wide=True)
            else:
                at = self.text.op(f"getelementptr double, ptr %base, i64 {number}")
                value = Number(self.text.op(f"load double, ptr {at}"), wide=False)
            self.store(slot, value)
