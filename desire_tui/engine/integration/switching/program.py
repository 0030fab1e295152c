"""Expressions of t, and jumps by states, as a program: instructions over registers, register 0 is t."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.data_classes import dataclass, field
from desire_tui.engine.integration.switching.operations import BY_NAME, Operation
from desire_tui.engine.lowered.expressions import Const, Load, Op, Table1
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from collections.abc import Mapping

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.switching import Switching


@dataclass
class Program:
    """Instructions (operation, to, from, from), constants by register, inputs' slots by register.

    The first `clock_count` instructions are those of expressions of t; `moving` are registers by slot, of t
    and states.
    """

    instructions: list[tuple[int, int, int, int]] = field(default_factory=list)
    constants: dict[int, float] = field(default_factory=dict)
    inputs: dict[int, int] = field(default_factory=dict)
    tables: list[tuple[int, int]] = field(default_factory=list)
    registers: int = 1
    clock_count: int = 0
    moving: dict[int, int] = field(default_factory=dict)
    origins: dict[int, Value] = field(default_factory=dict)
    """For an instruction the expression that it is made of."""


def write(switching: Switching) -> Program:
    """Translate what switches by t, and the modes' jumps where bounds of them can be told."""
    writer = _Writer(switching.definitions)
    for clock, _ in switching.clocks:
        writer.of(clock)
    program = writer.program
    program.clock_count = len(program.instructions)
    for slot in switching.moving:
        program.moving[slot] = writer.slot(slot)
        program.inputs.pop(program.moving[slot], None)
    for jump in switching.bounded:
        writer.of(jump)
    return program


class _Writer:
    def __init__(self, definitions: Mapping[int, Value]) -> None:
        self.program = Program()
        self._definitions = definitions
        self._known: dict[int, int] = {}
        self._slots: dict[int, int] = {T: 0}
        self._same: dict[tuple[int, int, int], int] = {}

    def of(self, value: Value) -> int:
        """Return the register of an expression."""
        known = self._known.get(id(value))
        if known is None:
            known = self._known[id(value)] = self._of(value)
        return known

    def _of(self, value: Value) -> int:
        if isinstance(value, Const):
            return self._constant(value.value)
        if isinstance(value, Load):
            return self.slot(value.slot)
        if isinstance(value, Table1):
            self.program.tables.append((value.slot, value.count))
            return self._emit(Operation.TABLE, self.of(value.x), len(self.program.tables) - 1, value)
        assert isinstance(value, Op)
        if value.name == "ipow":
            return self._power(value)
        arguments = [self.of(argument) for argument in value.args]
        if value.name == "recip":
            return self._emit(Operation.DIV, self._constant(1.0), arguments[0], value)
        if value.name == "tri":
            size = self._emit(Operation.ABS, arguments[0], arguments[0], value)
            return self._emit(Operation.SUB, self._constant(1.0), size, value)
        if value.name == "comp":  # minus + (plus - minus)·swtch(x)
            above = self._emit(Operation.SWTCH, arguments[0], arguments[0], value)
            rise = self._emit(Operation.SUB, arguments[2], arguments[1], value)
            return self._emit(
                Operation.ADD, arguments[1], self._emit(Operation.MUL, rise, above, value), value
            )
        return self._emit(BY_NAME[value.name], arguments[0], arguments[-1], value)

    def slot(self, slot: int) -> int:
        """Return the register of a scalar."""
        if slot not in self._slots:
            definition = self._definitions.get(slot)
            if definition is None:
                self._slots[slot] = register = self._register()
                self.program.inputs[register] = slot
            else:
                self._slots[slot] = self.of(definition)
        return self._slots[slot]

    def _power(self, value: Op) -> int:
        exponent = value.args[1]
        assert isinstance(exponent, Const)
        x, n = self.of(value.args[0]), int(exponent.value)
        if n == 0:
            return self._constant(1.0)
        result = x
        for bit in bin(abs(n))[3:]:
            result = self._emit(Operation.MUL, result, result, value)
            if bit == "1":
                result = self._emit(Operation.MUL, result, x, value)
        return self._emit(Operation.DIV, self._constant(1.0), result, value) if n < 0 else result

    def _constant(self, number: float) -> int:
        register = self._register()
        self.program.constants[register] = number
        return register

    def _register(self) -> int:
        self.program.registers += 1
        return self.program.registers - 1

    def _emit(self, operation: Operation, a: int, b: int, origin: Value) -> int:
        program = self.program
        key = (int(operation), a, b)
        if key not in self._same:
            self._same[key] = to = self._register()
            program.origins[len(program.instructions)] = origin
            program.instructions.append((int(operation), to, a, b))
        return self._same[key]


def as_arrays(program: Program) -> tuple[np.ndarray[tuple[int, ...], np.dtype[np.int64]], ...]:
    """Return instructions, tables, inputs' slots and their registers."""
    return tuple(
        np.array(numbers or [0], dtype=np.int64).reshape(-1)
        for numbers in (
            program.instructions, program.tables, list(program.inputs.values()), list(program.inputs),
        )
    )  # fmt: skip
