"""What the closures of a model's passes share: the numbers, the random sequence, the run, the derivatives."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from desire_tui.engine.reference.expressions import ExpressionClosures
from desire_tui.engine.reference.random import Sequence

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.runtime.moments.memory import Moments
    from desire_tui.engine.runtime.run_memory import RunMemory
    from desire_tui.engine.values import Values

    Array = NDArray[np.float64]
    Thunk = Callable[[], Any]


class EvaluationContext:
    """Where closures read and write.

    `memory` is the run's, `derivatives` the array that passes write to, `fired` the first `term` that fired
    in this pass (None: none).
    """

    def __init__(self, values: Values, order: int) -> None:
        self.values = values
        self.cells, self.data = values.cells, values.data
        self.derivatives: Array = np.zeros(order)
        self.sequence = Sequence(values.random)
        self.memory: RunMemory | None = None
        self.fired: int | None = None
        self.histories: list[Moments] = []
        """What `delay(x, tau)` remembers: one, once the model has it."""

    def value(self, value: Value, count: int | None = None) -> Thunk:
        """Return the closure of an expression over a number or `count` elements."""
        expressions = ExpressionClosures(self.values, self.sequence, count, self.histories)
        thunk = expressions.compile(value)
        if expressions.is_plain:
            return thunk

        def prepared() -> Any:
            expressions.begin()
            return thunk()

        return prepared
