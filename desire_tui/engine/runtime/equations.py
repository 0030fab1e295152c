"""What a back end offers other people's solvers: a segment's derivatives as functions of t and the states."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from desire_tui.engine.integration.pattern import Pattern

    Floats = NDArray[np.float64]


class Equations(Protocol):
    """Of one segment, over its values: parameters count as they stand there. One thread at a time.

    n states in the segment's order. What is not finite is returned as it is.
    """

    pattern: Pattern
    """Where the Jacobian may differ from 0."""

    @property
    def addresses(self) -> tuple[int, int] | None:
        """Of the C functions: right-hand side and Jacobian; None: there are none."""
        ...

    def derivatives(self, t: float, x: Floats) -> Floats:
        """Return dx/dt, n numbers; x is contiguous."""
        ...

    def many(self, times: Floats, states: Floats) -> Floats:
        """Return dx/dt at several places, m by n, for m times and m by n states, all contiguous."""
        ...

    def jacobian(self, t: float, x: Floats) -> Floats:
        """Return the Jacobian, n by n."""
        ...

    def jacobians(self, times: Floats, states: Floats) -> Floats:
        """Return the Jacobians at several places, m by n by n, for m times and m by n states, contiguous."""
        ...

    def entries(self, t: float, x: Floats) -> Floats:
        """Return the Jacobian's entries in the order of the pattern."""
        ...
