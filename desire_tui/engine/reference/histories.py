"""Statements that remember, or count communication points, as Python closures."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any

from desire_tui.engine.lowered.statements import DelayLine, StoreHistory, UpdateTrackHold

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.lowered.statements import GetHistory
    from desire_tui.engine.reference.evaluation_context import EvaluationContext
    from desire_tui.engine.runtime.run_memory import RunMemory

    Run = Callable[[], None]


def sampled(context: EvaluationContext, every: int, body: Run) -> Run:
    """Return what carries `body` out at every m-th communication point (`SAMPLE m`)."""

    def run() -> None:
        memory = context.memory
        assert memory is not None
        if (memory.points_before + memory.point + 1) % every == 0 and _is_fresh(memory):
            body()

    return run


def history(
    context: EvaluationContext, action: StoreHistory | GetHistory | DelayLine | UpdateTrackHold
) -> Run:
    """Return the closure of a statement that remembers."""
    cells = context.cells
    if isinstance(action, UpdateTrackHold):
        control, value = context.value(action.control), context.value(action.value)
        held, tracked = action.held_slot, action.tracked_slot

        def track() -> None:
            p, x = control(), value()
            if p > 0.0:
                cells[held] = cells[tracked]
                cells[tracked] = x

        return track
    if isinstance(action, DelayLine):
        return _delay(context, action)
    array = action.array_slot
    count, counter, slot = action.count, action.counter, action.slot
    stores = isinstance(action, StoreHistory)

    def move() -> None:
        memory = context.memory
        assert memory is not None
        positions = _integers(memory.counters, counter + 1)
        fresh = _is_fresh(memory)
        at = positions[counter] - (not fresh)
        if not 0 <= at < count:
            return
        if not stores:
            cells[slot] = cells[array + at]
        elif fresh:
            cells[array + at] = cells[slot]
        positions[counter] = at + 1

    return move


def _delay(context: EvaluationContext, action: DelayLine) -> Run:
    source = context.value(action.source)
    cells, buffer, count = context.cells, action.buffer_slot, action.count
    slot, counter = action.slot, action.counter

    def delay() -> None:
        memory = context.memory
        assert memory is not None
        x = source()
        positions, lags = _integers(memory.counters, counter + 1), _integers(memory.lags, counter + 1)
        fresh, lag = _is_fresh(memory), lags[counter]
        at = positions[counter] - (not fresh)
        if not fresh and (at < 0 or lag == count):
            return  # the joint's own record stands where the one looked for was
        cells[slot] = x if lag == 0 else cells[buffer + (at - lag) % count]
        if fresh:
            cells[buffer + at % count] = x
        positions[counter] = at + 1

    return delay


def _is_fresh(memory: RunMemory) -> bool:
    """Whether this is not the joint of a continued run, which had its turn in the run before.

    `get` and delays read at a joint what they read there before: the script may have changed what they
    assign, and the first interval must not begin with that.
    """
    return not (memory.joined and memory.point == 0)


def _integers(address: int, count: int) -> Any:
    return (ctypes.c_int64 * count).from_address(address)
