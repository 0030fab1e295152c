"""Which statements each of a segment's passes holds."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.lowered.statements import Deriv
from desire_tui.engine.passes.final_sample import holds_term
from desire_tui.engine.passes.renewal import renewals
from desire_tui.engine.passes.slices import final_sample_pass, full_pass, inner_slices

if TYPE_CHECKING:
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.statements import Action


NO_MORE: dict[str, tuple[Action, ...]] = dict.fromkeys(
    ("tail", "renewal", "step_renewal", "watch_stage", "watch_end"), ()
)


def passes_of(segment: Segment, *, variable: bool = False) -> dict[str, tuple[Action, ...]]:
    """Return the statements of each of the passes; `variable`: for a rule that tests its steps by k1."""
    if all(type(action) is Deriv for action in segment.body):
        return dict.fromkeys(("derivative", "step", "full"), segment.body) | NO_MORE
    point, step = renewals(segment) if variable else ((), ())
    stage_pass, step_pass = inner_slices(segment)
    return NO_MORE | {
        "renewal": point,
        "step_renewal": step,
        "derivative": stage_pass,
        "step": step_pass,
        "full": full_pass(segment),
        # made only after a `term` has fired
        "tail": final_sample_pass(segment) if holds_term(segment.body) else (),
    }
