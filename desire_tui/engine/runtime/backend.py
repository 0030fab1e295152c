"""What a back end offers the run loop."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from desire_tui.engine.diagnostics import Diagnostic
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.runtime.equations import Equations
    from desire_tui.engine.runtime.run_memory import Ended, RunMemory
    from desire_tui.engine.values import Values


class Model(Protocol):
    """A segment made ready for one rule."""

    def advance(self, memory: RunMemory) -> Ended:
        """Run on (see `run_memory`), from any one thread at a time. Native code frees the interpreter."""
        ...


class Backend(Protocol):
    """Makes models. The native one keeps what it compiled: asking again for a segment costs nothing."""

    name: str

    def model(self, segment: Segment, rule: int, values: Values, *, is_free: bool = False) -> Model:
        """Prepare `segment` for an integration rule. DesireError 86: there is no such rule.

        `is_free`, under rules 4, 7 and 8: steps go beyond communication points; the segment must let them
        (`passes.point_effects.may_pass_points`).
        """
        ...

    def equations(self, segment: Segment, values: Values) -> Equations:
        """Return the derivatives as functions of t and x. DesireError 491: they are none."""
        ...

    def forget(self) -> None:
        """Drop all models: their segments will not come again."""
        ...

    def problems(self) -> tuple[Diagnostic, ...]:
        """Return what went wrong in the background since somebody asked."""
        ...
