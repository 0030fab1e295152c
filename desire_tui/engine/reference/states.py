"""The states as one vector: fetched, put back, moved by a row of a rule's tableau.

`UnrolledStates` writes the sums out as Python text for a model of few states, `ArrayStates` leaves them to
NumPy. Both add whole multiples in the order of the k's and multiply by DT/denominator, as native code does.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from desire_tui.engine.integration.tableaus import whole_multiples
from desire_tui.engine.lowered.state_ranges import state_ranges

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from desire_tui.engine.integration.tableaus import Row, Tableau
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.state_ranges import Range
    from desire_tui.engine.values import Values

    Array = NDArray[np.float64]

UNROLLED_MOST = 24
"""States up to which sums written out are faster than NumPy's."""


class States(Protocol):
    """What the run loop asks of the states. `k[i]` are the derivatives of stage i."""

    k: list[Array]

    def fetch(self) -> Any:
        """Return a copy of the states."""

    def put(self, x: Any) -> None:
        """Set the states."""

    def move(self, stage: int, start: Any, dt: float) -> None:
        """States ← start + dt·Σ a[stage]·k; for the number of stages: the step's result with b."""


def make_states(segment: Segment, tableau: Tableau | None, values: Values, derivatives: Array) -> States:
    """Return the kind of states that suits the segment."""
    rows = [] if tableau is None else [*tableau.a, tableau.b]
    ranges = state_ranges(segment.states)
    kind = UnrolledStates if segment.order <= UNROLLED_MOST else ArrayStates
    return kind(ranges, segment.order, rows, values, derivatives)


class ArrayStates:
    """States as NumPy arrays."""

    def __init__(
        self, ranges: list[Range], order: int, rows: Sequence[Row], values: Values, first: Array
    ) -> None:
        self.ranges, self.order = ranges, order
        self.sums = [whole_multiples(row) for row in rows]
        self.data = values.data
        self.k = [first, *(np.zeros(order) for _ in rows[2:])]

    def fetch(self) -> Array:
        """Return a copy of the states."""
        x = np.empty(self.order)
        for slot, first, count in self.ranges:
            x[first : first + count] = self.data[slot : slot + count]
        return x

    def put(self, x: Array) -> None:
        """Set the states."""
        for slot, first, count in self.ranges:
            self.data[slot : slot + count] = x[first : first + count]

    def move(self, stage: int, start: Array, dt: float) -> None:
        """States ← start + dt·Σ row·k."""
        denominator, multiples = self.sums[stage]
        self.put(start + dt / denominator * sum_of_multiples(multiples, self.k))


class UnrolledStates(ArrayStates):
    """States as a tuple of floats, sums as text."""

    def __init__(
        self, ranges: list[Range], order: int, rows: Sequence[Row], values: Values, first: Array
    ) -> None:
        super().__init__(ranges, order, rows, values, first)
        slots = [slot + i for slot, _, count in ranges for i in range(count)]
        names: dict[str, Any] = {"c": values.cells}
        names |= {f"k{i}": k.data for i, k in enumerate(self.k)}
        lines = ["def fetch(): return (" + "".join(f"c[{slot}], " for slot in slots) + ")", "def put(x):"]
        lines += [f" c[{slot}] = x[{n}]" for n, slot in enumerate(slots)] or [" pass"]
        for stage, (denominator, multiples) in enumerate(self.sums):
            lines += [f"def move{stage}(x, dt):", f" dt = dt / {denominator}.0"]
            for n, slot in enumerate(slots):
                total = " + ".join(f"{m}.0 * k{i}[{n}]" for i, m in enumerate(multiples) if m) or "0.0"
                lines.append(f" c[{slot}] = x[{n}] + dt * ({total})")
            lines.append(" return")
        exec(compile("\n".join(lines), "<states>", "exec"), names)  # noqa: S102 - numbers and slots only
        self._fetch: Callable[[], Any] = names["fetch"]
        self._put: Callable[[Any], None] = names["put"]
        self._moves: list[Callable[[Any, float], None]] = [names[f"move{i}"] for i in range(len(rows))]

    def fetch(self) -> Any:
        """Return the states as a tuple."""
        return self._fetch()

    def put(self, x: Any) -> None:
        """Set the states."""
        self._put(x)

    def move(self, stage: int, start: Any, dt: float) -> None:
        """States ← start + dt·Σ row·k."""
        self._moves[stage](start, dt)


def sum_of_multiples(multiples: Sequence[int], k: Sequence[Array]) -> Array:
    """Return Σ multiple·k, added in the order of the k's."""
    total: Array | None = None
    for multiple, one in zip(multiples, k, strict=False):
        if multiple:
            total = float(multiple) * one if total is None else total + float(multiple) * one
    return np.zeros_like(k[0]) if total is None else total
