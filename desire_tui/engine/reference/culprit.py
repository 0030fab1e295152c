"""Which part of a model made an inf or nan: the failed steps once more, each expression looked at.

The compiled loop looks for inf and nan now and then, and says what became of a state. Here the last
samples' steps are made again by the reference back end until a derivative is not finite; of the
expressions that it was computed from, the smallest whose operands are numbers and whose value is none is
the culprit.
"""

from __future__ import annotations

from itertools import count
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from desire_tui.engine.integration.rules import DUMMY, rule_numbered
from desire_tui.engine.lowered.effects import expressions
from desire_tui.engine.lowered.expressions import Op
from desire_tui.engine.lowered.statements import Deriv, DerivVec, Guard, Set, SetMat, SetVec
from desire_tui.engine.lowered.walk import operands
from desire_tui.engine.passes.slices import derivative_slice
from desire_tui.engine.reference.backend import ReferenceBackend
from desire_tui.engine.reference.expressions import ExpressionClosures
from desire_tui.engine.reference.model import ReferenceModel
from desire_tui.engine.reference.random import Sequence
from desire_tui.engine.reference.stiff import StiffReferenceModel
from desire_tui.engine.runtime.block_start import BlockStart
from desire_tui.engine.runtime.run_memory import Ended, Phase
from desire_tui.engine.values import DT, T

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.statements import Action
    from desire_tui.engine.runtime.backend import Model
    from desire_tui.engine.runtime.run_memory import RunMemory
    from desire_tui.engine.values import Values

PASSES_MOST = 20_000
"""The error is not kept waiting for longer than these take: about a second."""
_CHUNKS = 32
_ROWS_BEHIND = PASSES_MOST // 4
"""Samples behind the last one that a run can have missed whose step failed: rules 4, 7, 8 may pass points."""


class Culprit(NamedTuple):
    """An operation `part` of a statement's expression `whole`, its operands' values, and the time."""

    action: Action
    whole: Value
    part: Op
    numbers: tuple[float, ...]
    t: float


class _Found(BaseException):
    """A derivative that is not finite has just been computed."""


class _TooLong(BaseException):
    """The time is over."""


def find_culprit(
    start: BlockStart, segment: Segment, rule: int, model: Model, values: Values
) -> Culprit | None:
    """Return what made the inf or nan with which a run has just ended; everything is left as it was.

    None where it cannot be told: steps that events cut, or that look into the past, are not made again:
    the start of a block does not hold what those remember.
    """
    if segment.events or segment.delays:
        return None
    counters = start.counters
    after = BlockStart.here(start.memory, counters, values)
    rows = int(start.memory.row)
    start.put_back(values)
    memory = start.memory
    width = 1 + len(segment.columns)
    samples = rows - int(memory.row) + 3
    passes_points = rule_numbered(rule).kind == "variable" and memory.dt_max > memory.comint
    rows_behind = _ROWS_BEHIND if passes_points else 1
    scratch = np.empty(max(samples, rows_behind) * width)
    memory.row, memory.rows = 0, scratch.ctypes.data
    try:
        with np.errstate(all="ignore"):
            for chunk in dict.fromkeys((max(samples // _CHUNKS, 1), 1)):
                _go_near(memory, counters, model, values, chunk, samples - 1)
            memory.row, memory.row_limit = 0, rows_behind
            return _replayed(segment, rule, values, memory)
    finally:
        after.put_back(values)


def _go_near(
    memory: RunMemory,
    counters: NDArray[np.int64],
    model: Model,
    values: Values,
    chunk: int,
    most: int,
) -> None:
    """Run on by `chunk` samples at a time, and stay where the run would end."""
    _take_up(memory)
    while True:
        before = BlockStart.here(memory, counters, values)
        memory.row_limit = min(int(memory.row) + chunk, most)
        if memory.row >= most or model.advance(memory) is not Ended.RUNNING:
            before.put_back(values)
            return


def _take_up(memory: RunMemory) -> None:
    """Behind a sample go on with the pass at the step's start: k1 of then is gone."""
    if memory.phase == Phase.AFTER_POINT:
        memory.phase = Phase.IN_STEP


def _replayed(segment: Segment, rule: int, values: Values, memory: RunMemory) -> Culprit | None:
    if segment.order and rule != DUMMY:
        _take_up(memory)
    else:
        memory.phase = Phase.AT_POINT  # points alone, no steps between them
    model = ReferenceBackend().model(segment, rule, values)
    assert isinstance(model, ReferenceModel)
    passes = count()
    if isinstance(model, StiffReferenceModel):
        _watch_stiff(model, passes)
        model.system.begin(memory, values.cells[DT])
    else:
        _watch(model, passes)
    try:
        model.advance(memory)
    except _Found:
        return _culprit(segment, values)
    except _TooLong:
        return None
    return None


def _watched(
    run: Callable[[], None], derivatives: NDArray[np.float64], passes: Iterator[int]
) -> Callable[[], None]:
    def watched() -> None:
        run()
        if not np.isfinite(derivatives).all():
            raise _Found
        if next(passes) > PASSES_MOST:
            raise _TooLong

    return watched


def _watch(model: ReferenceModel, passes: Iterator[int]) -> None:
    k = model.states.k
    model.full, model.step = (_watched(run, k[0], passes) for run in (model.full, model.step))
    model.stages = [_watched(run, rate, passes) for run, rate in zip(model.stages, k[1:], strict=True)]


def _watch_stiff(model: StiffReferenceModel, passes: Iterator[int]) -> None:
    compute = model.derivatives

    def watched(t: float, y: Any, out: Any) -> None:
        compute(t, y, out)
        if not np.isfinite(out).all():
            raise _Found
        if next(passes) > PASSES_MOST:
            raise _TooLong

    model.derivatives = watched  # type: ignore[method-assign]


def _culprit(segment: Segment, values: Values) -> Culprit | None:
    """Return the first operation of a pass that made something of numbers which is none."""
    for action in _executed(derivative_slice(segment), values):
        size = action.count if isinstance(action, SetVec | DerivVec) else None
        if isinstance(action, SetMat):
            size = action.rows * action.cols
        for whole in expressions(action):
            part: Value = whole
            if _is_finite(_value(part, size, values)):
                continue
            while True:
                inner = next(
                    (one for one in operands(part) if not _is_finite(_value(one, size, values))), None
                )
                if inner is None:
                    break
                part = inner
            if not isinstance(part, Op):
                return None
            result = np.atleast_1d(_value(part, size, values))
            at = int(np.argmin(np.isfinite(result)))
            numbers = tuple(
                float(np.broadcast_to(_value(one, size, values), result.shape)[at]) for one in part.args
            )
            return Culprit(action, whole, part, numbers, values.cells[T])
    return None


def _executed(actions: tuple[Action, ...], values: Values) -> Iterator[Action]:
    for action in actions:
        if not isinstance(action, Guard):
            if isinstance(action, Set | SetVec | SetMat | Deriv | DerivVec):
                yield action
        elif action.kind == "if" and action.condition is not None:
            holds = float(_value(action.condition, None, values)) > 0.0
            yield from _executed(action.body if holds else action.orelse, values)


def _value(node: Value, count: int | None, values: Values) -> Any:
    closures = ExpressionClosures(values, Sequence(values.random), count)
    value = closures.compile(node)
    closures.begin()
    return value()


def _is_finite(value: Any) -> bool:
    return bool(np.isfinite(value).all())
