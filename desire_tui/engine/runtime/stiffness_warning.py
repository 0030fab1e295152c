"""A warning behind a run: a corrector without the whole matrix has failed at every second or third step.

Such a corrector, by substitution (rules 9, 13) or with the diagonal alone (12, 16), converges only while
steps are short beside the fastest coupling of states. That keeps the steps of a stiff model small long after
its transients are over (Hairer and Wanner, Solving Ordinary Differential Equations II, IV.8), and nothing
else would say so: the run ends well, after a hundred times the steps of rule 14.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import Diagnostic
from desire_tui.engine.integration.rules import rule_numbered

if TYPE_CHECKING:
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.runtime.run_record import RunRecord

_STEPS_LEAST = 2000
_FAILURES_LEAST = 0.3
"""As a part of steps; where the error test alone rejects steps it is a tenth."""


def stiffness_warning(segment: Segment, record: RunRecord) -> tuple[Diagnostic, ...]:
    """Return the warning, or nothing."""
    rule = rule_numbered(record.rule)
    if rule.corrector not in {"fixed-point", "diagonal"} or record.steps < _STEPS_LEAST:
        return ()
    if record.rejected < _FAILURES_LEAST * record.steps:
        return ()
    facts = {"rule": record.rule, "steps": record.steps, "rejected": record.rejected}
    where = segment.states[0].where
    return (Diagnostic("corrector-slow", where.span, facts, segment.source, "warning"),)
