"""Makes models out of lowered segments."""

from __future__ import annotations

from collections import OrderedDict
from typing import TYPE_CHECKING

from desire_tui.engine.codegen.compiler_state import CompilerState, shared_state
from desire_tui.engine.codegen.native_model import NativeModel
from desire_tui.engine.codegen.pieces import kept_pieces
from desire_tui.engine.codegen.scalar import rerolling, templates
from desire_tui.engine.diagnostics import Diagnostic
from desire_tui.engine.gc_pause import undisturbed_allocation
from desire_tui.engine.integration.rules import rule_numbered

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.codegen.lanes.lane_model import LaneModel
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.runtime.backend import Model
    from desire_tui.engine.runtime.equations import Equations
    from desire_tui.engine.values import Values


_MODELS_MOST = 32


class NativeBackend:
    """Native code through LLVM, for all rules."""

    name = "native"

    def __init__(self, compiler: CompilerState | None = None) -> None:
        self._compiler = compiler or shared_state()
        self._models: OrderedDict[tuple[int, int, int, bool], tuple[Segment, Values, Model]] = OrderedDict()

    def model(self, segment: Segment, rule: int, values: Values, *, is_free: bool = False) -> Model:
        """Prepare `segment` for a rule; the same segment again costs nothing, until `forget`."""
        improver = self._compiler.improver
        key = (id(segment), rule, id(values), is_free)
        known = self._models.get(key)
        if known is not None:
            self._models.move_to_end(key)
            if isinstance(known[2], NativeModel):
                improver.again(known[2])
            return known[2]
        with improver.held(), undisturbed_allocation:
            made = self._make(segment, rule, values, is_free=is_free)
        self._models[key] = (segment, values, made)  # the key's ids stay taken as long as these live
        while len(self._models) > _MODELS_MOST:
            self._models.popitem(last=False)
        return made

    def equations(self, segment: Segment, values: Values) -> Equations:
        """Return the derivatives as functions of t and x. DesireError 491: they are none."""
        from desire_tui.engine.codegen.equations.native_equations import NativeEquations

        with self._compiler.improver.held(), undisturbed_allocation:
            return NativeEquations(self._compiler.code, self._compiler.improver, segment, values)

    def lanes(
        self,
        segment: Segment,
        rule: int,
        values: Values,
        given: Sequence[int],
        columns: Sequence[int],
        folds: Sequence[str],
        *,
        fast: bool,
    ) -> LaneModel:
        """Prepare `segment` for runs in lock step that differ in the `given` slots.

        `folds`: what is kept of each column (`lanes.lane_folds`); none: all samples.

        LockStepError: what keeps them from it.
        """
        from desire_tui.engine.codegen.lanes.lane_model import LaneModel

        return LaneModel(
            self._compiler.code,
            self._compiler.improver,
            segment,
            rule,
            values,
            given,
            columns,
            folds,
            fast=fast,
        )

    def forget(self) -> None:
        """Drop all models: their segments will not come again. What was compiled for them may."""
        self._models.clear()
        rerolling.age()
        templates.age()
        kept_pieces.age()

    def problems(self) -> tuple[Diagnostic, ...]:
        """Return what kept fast code from being made since somebody asked; quick code runs instead."""
        return tuple(
            Diagnostic(
                "fast-code-missing", facts={"reason": f"{type(fault).__name__}: {fault}"}, severity="warning"
            )
            for fault in self._compiler.improver.faults()
        )

    def _make(self, segment: Segment, rule: int, values: Values, *, is_free: bool) -> Model:
        improver = self._compiler.improver
        code = self._compiler.code
        if segment.may_rearrange:
            from desire_tui.engine.codegen.jit.loose_code import LooseCode

            code = LooseCode(code)
        if (rule_numbered(rule).has_interpolant or is_free) and segment.order:
            from desire_tui.engine.codegen.stiff.stiff_model import StiffModel

            return StiffModel(code, improver, self._compiler.routines, segment, rule, values)
        if segment.events or segment.delays:
            from desire_tui.engine.codegen.moments.moment_model import MomentModel

            return MomentModel(code, improver, segment, rule, values)
        return NativeModel(code, improver, segment, rule, values)
