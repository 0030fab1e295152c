"""The back end that needs nothing but NumPy: the yardstick in tests, the way out without LLVM."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.integration.rules import rule_numbered
from desire_tui.engine.integration.tableaus import TABLEAUS
from desire_tui.engine.passes.assigned_states import stepped_segment
from desire_tui.engine.passes.switching import switching
from desire_tui.engine.passes.vital_columns import vital_columns
from desire_tui.engine.reference.model import ReferenceModel
from desire_tui.engine.reference.switches import Switches

if TYPE_CHECKING:
    from desire_tui.engine.diagnostics import Diagnostic
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.runtime.backend import Model
    from desire_tui.engine.runtime.equations import Equations
    from desire_tui.engine.values import Values


class ReferenceBackend:
    """Makes models out of Python closures."""

    name = "reference"

    def model(self, segment: Segment, rule: int, values: Values, *, is_free: bool = False) -> Model:
        """Prepare `segment` for an integration rule. DesireError 460, 461: a multistep one wants SUNDIALS."""
        kind = rule_numbered(rule).kind
        if not (rule_numbered(rule).has_interpolant or is_free):
            vital = vital_columns(segment)
            segment, numbers = stepped_segment(segment, values.room, variable=kind == "variable")
            switches = None
            if kind == "variable":
                segment, found = switching(segment, values.room)
                switches = None if found is None else Switches(found, segment, values)
            if segment.events or segment.delays:
                from desire_tui.engine.reference.moments import MomentReferenceModel

                tableau = TABLEAUS.get(rule) if segment.order else None
                return MomentReferenceModel(segment, tableau, values, numbers, vital, switches)
            return ReferenceModel(segment, TABLEAUS.get(rule), values, numbers, vital, switches)
        if segment.events or segment.delays:
            from desire_tui.engine.reference.stiff_moments import StiffMomentModel

            return StiffMomentModel(segment, rule, values)
        from desire_tui.engine.reference.stiff import StiffReferenceModel

        return StiffReferenceModel(segment, rule, values)

    def equations(self, segment: Segment, values: Values) -> Equations:
        """Return the derivatives as functions of t and x. DesireError 491: they are none."""
        from desire_tui.engine.reference.equations import ReferenceEquations

        return ReferenceEquations(segment, values)

    def forget(self) -> None:
        """Do nothing: no model is kept."""

    def problems(self) -> tuple[Diagnostic, ...]:
        """Return nothing: nothing goes on in the background."""
        return ()
