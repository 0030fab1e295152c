"""The memory behind a `Watch`, and the functions that fill it."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any

import numpy as np

from desire_tui.engine.integration.switching.clearance import begin_box, forget_box
from desire_tui.engine.integration.switching.memory import Compute, Place, Watch
from desire_tui.engine.integration.switching.program import as_arrays, write
from desire_tui.engine.lowered.switching import THRESHOLDS, Threshold

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from desire_tui.engine.lowered.statements import Where
    from desire_tui.engine.lowered.switching import Switching
    from desire_tui.engine.values import Values

_REALS, _INTS = ctypes.POINTER(ctypes.c_double), ctypes.POINTER(ctypes.c_int64)
_SPAN = 1e-9
"""Part of the run in which very many switchings are chattering."""


class Watcher:
    """A model's `Watch` with everything that it points at."""

    def __init__(self, switching: Switching, values: Values, ranges: Sequence[tuple[int, int, int]]) -> None:
        self.switching = switching
        self.watch = watch = Watch()
        self._kept: list[Any] = []
        self._program = program = write(switching)
        order = sum(count for _, _, count in ranges)
        watch.values = ctypes.cast(values.address, _REALS)
        slots, each = switching.slots, [mode for mode in switching.modes for _ in range(mode.count)]
        watch.count, watch.frozen, watch.live = switching.count, slots.frozen, slots.live
        watch.arguments = slots.arguments
        for name, numbers in (
            ("rising", [int(mode.rising) for mode in each]),
            ("thresholds", [int(THRESHOLDS[mode.operation]) for mode in each]),
        ):
            self._ints(name, np.array(numbers or [0], dtype=np.int64))
        watch.thresholds_are_0 = all(THRESHOLDS[mode.operation] is Threshold.ZERO for mode in each)
        for name in ("at_start", "changes"):
            self._reals(name, np.zeros(max(len(each), 1)))
        self._ints("ranges", np.array(ranges, dtype=np.int64).reshape(-1))
        watch.n, watch.range_count = order, len(ranges)
        for name in ("x0", "f0", "x1", "f1"):
            self._reals(name, np.zeros(max(order, 1)))
        watch.f1_address = ctypes.cast(watch.f1, ctypes.c_void_p).value or 0
        low = np.zeros(program.registers)
        for register, value in program.constants.items():
            low[register] = value
        self._reals("low", low)
        self._reals("high", low.copy())
        code, tables, inputs, registers = as_arrays(program)
        self._ints("instructions", code)
        self._ints("tables", tables)
        self._ints("inputs", inputs)
        self._ints("input_registers", registers)
        watch.instruction_count, watch.input_count = program.clock_count, len(program.inputs)
        watch.box_instruction_count = len(program.instructions)
        self.sides = tuple(program.moving)
        for name, sides in (("box_slots", self.sides), ("box_registers", program.moving.values())):
            self._ints(name, np.array([*sides, 0], dtype=np.int64))
        for name in ("box_low", "box_high", "reach_low", "reach_high", "box_last", "box_moves", "box_scale"):
            self._reals(name, np.zeros(len(self.sides) + 1))
        for name in ("before", "behind"):
            self._reals(name, np.zeros(max(len(program.instructions), 1)))
        self.address = ctypes.addressof(watch)

    def connect(
        self, begin: Callable[[Watch, float], object], modes: Any, derivative: Any, place: Any, owner: int
    ) -> None:
        """Set the functions: of ctypes' types, or addresses of native ones; `begin` is `watch.begin`."""
        self._begin = begin
        watch = self.watch
        watch.modes, watch.derivative = (_function(Compute, f) for f in (modes, derivative))
        watch.place, watch.owner = _function(Place, place), owner
        self._kept += [watch.modes, watch.derivative, watch.place]

    def take_step_from(self, x0: int, f0: int) -> None:
        """Let the step's start be in memory of the rule's own: addresses of states and derivatives there."""
        self.watch.x0, self.watch.f0 = (ctypes.cast(place, _REALS) for place in (x0, f0))

    def keep_box(self) -> None:
        """Look at modes only outside of a box in which none switches, where there is one (`clearance`)."""
        self.watch.box_count = len(self.sides)
        begin_box(self.watch)

    def forget_box(self) -> None:
        """Let nothing be known of inputs: the user may have changed them."""
        forget_box(self.watch)

    def begin(self, memory: Any) -> None:
        """Prepare a run: its memory, where it ends."""
        watch = self.watch
        watch.memory = ctypes.addressof(memory)
        watch.t_end = memory.t_start + memory.t_max
        watch.span = _SPAN * memory.t_max
        self._begin(watch, memory.t_start)

    def culprit(self) -> tuple[str, Where]:
        """Return the name and the place of what switched last."""
        switched = self.watch.switched
        if switched < 0:
            origin = self._program.origins[-1 - switched]
            for clock, where in self.switching.clocks:
                if clock is origin:
                    return getattr(clock, "name", "func1"), where
            clock, where = self.switching.clocks[0]
            return getattr(clock, "name", "func1"), where
        for mode in self.switching.modes:
            if mode.first <= switched < mode.first + mode.count:
                return mode.name, mode.where
        raise AssertionError(switched)

    def _ints(self, name: str, numbers: np.ndarray[Any, np.dtype[np.int64]]) -> None:
        self._kept.append(numbers)
        setattr(self.watch, name, ctypes.cast(numbers.ctypes.data, _INTS))

    def _reals(self, name: str, numbers: np.ndarray[Any, np.dtype[np.float64]]) -> None:
        self._kept.append(numbers)
        setattr(self.watch, name, ctypes.cast(numbers.ctypes.data, _REALS))


def _function(kind: Any, given: Any) -> Any:
    return ctypes.cast(given, kind) if isinstance(given, int) else given
