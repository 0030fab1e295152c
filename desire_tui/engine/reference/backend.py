"""The back end that needs nothing but NumPy: the yardstick in tests, and the way out where there is no LLVM."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.integration import TABLEAUS
from desire_tui.engine.reference.model import ReferenceModel

if TYPE_CHECKING:
    from desire_tui.engine.lowered import Segment
    from desire_tui.engine.runtime.backend import Model
    from desire_tui.engine.values import Values


class ReferenceBackend:
    """Makes models out of Python closures."""

    name = "reference"

    def model(self, segment: Segment, rule: int, values: Values) -> Model:
        """Prepare `segment` for integration rule 0 … 5, 7, 8. DesireError: another rule."""
        if rule == 0:
            return ReferenceModel(segment, None, values)
        tableau = TABLEAUS.get(rule)
        if tableau is None:
            raise DesireError(Diagnostic("rule-needs-native", facts={"rule": rule}, source=segment.source))
        return ReferenceModel(segment, tableau, values)
