"""Steady states of a system from many starts, each told once."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

import numpy as np

from desire_tui.analysis.equilibria.kinds import eigenvalues, kind
from desire_tui.analysis.equilibria.newton import newton
from desire_tui.engine.data_classes import dataclass, field

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from numpy.typing import NDArray

    from desire_tui.analysis.equilibria.newton import Outcome
    from desire_tui.analysis.equilibria.system import System

    Floats = NDArray[np.float64]

_SAME = 1e-5
"""Nearer to one another than this, in scaled coordinates, steady states are one."""
_BESIDE = 0.01
_FAMILY = 5
_TOLD_EVERY = 16


@dataclass(frozen=True)
class Steady:
    """A steady state x with the eigenvalues of the Jacobian there, those of conserved sums left out."""

    x: Floats
    z: Floats
    eigenvalues: NDArray[np.complex128]
    scale: float = 0.0
    """How large eigenvalues are nearby."""

    @property
    def kind(self) -> str:
        """Its name: `stable node`, `saddle`."""
        return kind(self.eigenvalues, self.scale)


@dataclass
class Found:
    """Steady states, and how the starts ended that led to none."""

    states: list[Steady] = field(default_factory=list)
    outcomes: Counter[Outcome] = field(default_factory=Counter)
    is_partial: bool = False

    @property
    def is_family(self) -> bool:
        """Whether they are many, and all degenerate: they must be points of a curve of steady states."""
        return len(self.states) >= _FAMILY and all(s.kind == "degenerate" for s in self.states)


def search(
    system: System,
    starts: Iterable[Floats],
    p: Mapping[str, float],
    go_on: Callable[[int], bool] = lambda _: True,
    within: Callable[[Floats], bool] = lambda _: True,
) -> Found:
    """Find steady states from starts x; `go_on(count)` is asked now and then, `within(x)` of each found."""
    found = Found()
    for number, start in enumerate(starts):
        if number % _TOLD_EVERY == 0 and not go_on(number):
            found.is_partial = True
            break
        ended = newton(system, system.place(start), p)
        found.outcomes[ended.outcome] += 1
        if ended.outcome != "found" or not np.all(np.isfinite(ended.z)):
            continue
        if any(is_same(ended.z, other.z) for other in found.states):
            continue
        x = system.states(ended.z)
        if within(x):
            found.states.append(steady_at(system, ended.z, p))
    return found


def is_same(z: Floats, other: Floats) -> bool:
    """Whether two places are one but for rounding."""
    return float(np.abs(z - other).max(initial=0.0)) <= _SAME * (1.0 + float(np.abs(other).max(initial=0.0)))


def steady_at(system: System, z: Floats, p: Mapping[str, float]) -> Steady:
    """Return the steady state at a place that Newton's method has found."""
    near = np.round(z)
    clean = np.where(np.abs(z - near) < 1e-13, near, z) + 0.0
    beside = eigenvalues(system.jacobian(clean + _BESIDE * (1.0 + np.abs(clean)), p))
    values = eigenvalues(system.jacobian(clean, p))
    return Steady(system.states(clean), clean, values, float(np.abs(beside).max(initial=0.0)))
