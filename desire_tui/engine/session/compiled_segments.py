"""Compiled segments: made at the first drun that needs them, kept as long as their names mean the same."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.integration.rules import rule_numbered
from desire_tui.engine.runtime.stash import read_stash, with_recovery
from desire_tui.engine.session.remembered_segments import RememberedSegments

if TYPE_CHECKING:
    from pathlib import Path

    from desire_tui.engine.codegen.compiler_state import CompilerState
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.nodes.program import Program
    from desire_tui.engine.passes.table_jumps import TableJumps
    from desire_tui.engine.runtime.backend import Backend, Model
    from desire_tui.engine.runtime.plan import RunPlan
    from desire_tui.engine.session.kept_expressions import KeptExpressions
    from desire_tui.engine.structure.structure import Structure
    from desire_tui.engine.values import Values
    from desire_tui.engine.warm_start.program_start import ProgramStart

BACKENDS = ("native", "reference")


def make_backend(name: str, compiler: CompilerState | None = None) -> Backend:
    """Return the back end; `compiler` keeps what a native one compiles (default: all sessions share that)."""
    if name == "native":
        from desire_tui.engine.codegen.backend import NativeBackend

        return NativeBackend(compiler)
    from desire_tui.engine.reference.backend import ReferenceBackend

    return ReferenceBackend()


class CompiledSegments:
    """Segments of the active program, by label."""

    def __init__(self, values: Values, backend: str, compiler: CompilerState | None = None) -> None:
        if backend not in BACKENDS:
            raise ValueError(f"backend={backend!r} is unknown; there are {' and '.join(map(repr, BACKENDS))}")
        self._values = values
        self._compiler = compiler
        self._backend_name = backend
        self.start: ProgramStart | None = None
        """The active program's, if it is large and the first of its kind in this process."""
        self._backend: Backend | None = None
        self._kept: dict[tuple[str | None, int], Segment] = {}
        self._backward: dict[int, tuple[Segment, Segment]] = {}
        self._jumping: dict[int, tuple[Segment, TableJumps, Segment]] = {}
        self._expressions: KeptExpressions | None = None
        self._names_of: tuple[int, int] = (-1, 0)
        self._program: Program | None = None
        self._remembered: RememberedSegments | None = None
        self._histories: dict[str | None, tuple[Segment, tuple[int, ...], int]] = {}

    @property
    def backend(self) -> Backend:
        """The back end, loaded when it is needed first: that takes some 50 ms."""
        if self._backend is None:
            self._backend = make_backend(self._backend_name, self._compiler)
        return self._backend

    def forget(self) -> None:
        """Compile everything anew at the next drun."""
        self._kept.clear()
        self._backward.clear()
        self._jumping.clear()
        self._histories.clear()
        if self._remembered is not None:
            self._remembered.begin()
        elif self._backend is not None:
            self._backend.forget()

    @property
    def are_remembered(self) -> bool:
        """Whether `remember` was called."""
        return self._remembered is not None

    def remember(self) -> None:
        """From now on keep what was compiled for a program that is run anew with the same names."""
        self._remembered = RememberedSegments(self._values)

    def lowered(
        self, program: Program, structure: Structure, label: str | None, rule: int, *, anew: bool = False
    ) -> Segment:
        """Return a segment ready for a back end. DesireError: everything that is wrong with it; 215: none.

        `anew`: subscripts and the like are computed again; nothing is compiled where they are what they were.
        """
        names = self._values.generation, self._values.replacements
        if names != self._names_of or program is not self._program:
            self.forget()
            self._names_of, self._program = names, program
        known = self._kept.get((label, rule))
        if known is None or (anew and not self._holds(known)):
            if program.segment(label) is None:
                key = "no-dynamic-segment" if label is None else "no-such-segment"
                raise DesireError(Diagnostic(key, facts={"label": label}))
            known = self._kept[label, rule] = self._lower(program, label, structure, rule)
        return known

    def keep(self, expressions: KeptExpressions | None) -> None:
        """Let every segment made from now on compute and sample some expressions besides its own."""
        self._expressions = expressions
        self.forget()

    def _lower(self, program: Program, label: str | None, structure: Structure, rule: int) -> Segment:
        def made() -> Segment:
            if self._expressions is not None:
                return self._expressions.lower(program, label, self._values, structure, rule)
            if self.start is not None:
                return self.start.lowered(program, label, self._values, structure, rule)
            from desire_tui.engine.lowering.lowering import lower

            return lower(program, label, self._values, structure, rule)

        if self._remembered is None:
            return made()
        return self._remembered.segment((program.source.text, label, rule), made)

    def _holds(self, segment: Segment) -> bool:
        """Whether the numbers that a segment was compiled with are what they were."""
        cells = self._values.cells
        return all(cells[slot] == value for slot, value in segment.constants)

    def directed(self, segment: Segment, plan: RunPlan) -> Segment:
        """Return the segment that a run follows.

        For a negative TMAX it is the one over -t; jumps of tables are switches where the rule locates them.
        """
        if segment.breakpoints and rule_numbered(plan.rule).kind in {"variable", "multistep"}:
            segment = self._with_table_jumps(segment)
        if not plan.backward:
            return segment
        known = self._backward.get(id(segment))
        if known is None:
            from desire_tui.engine.passes.backward import backward

            turned = backward(segment, self._values.unnamed(1))
            known = self._backward[id(segment)] = segment, turned
        return known[1]

    def _with_table_jumps(self, segment: Segment) -> Segment:
        from desire_tui.engine.passes.table_jumps import table_jumps, with_table_jumps

        jumps = table_jumps(segment, self._values.data)
        if not jumps:
            return segment
        known = self._jumping.get(id(segment))
        if known is None or known[1] != jumps:
            known = self._jumping[id(segment)] = segment, jumps, with_table_jumps(segment, jumps)
        return known[2]

    def model_of(self, segment: Segment, plan: RunPlan) -> Model:
        """Return a segment made ready for a run."""
        if not plan.is_free:
            return self.model(segment, plan.rule)
        from desire_tui.engine.passes.point_effects import may_pass_points

        return self.model(segment, plan.rule, is_free=may_pass_points(segment))

    def model(self, segment: Segment, rule: int, *, is_free: bool = False) -> Model:
        """Return a segment made ready for a rule; the back end keeps it (`runtime.backend`)."""
        remembered, way = self._remembered, (rule, is_free)
        if remembered is None:
            return self._model(segment, way)
        if remembered.may_use_model(segment, way):
            return self._model(segment, way)
        if remembered.forget_models(segment, way):
            self.backend.forget()
        before = self._values.layout()
        made = self._model(segment, way)
        remembered.note_model(segment, way, before)
        return made

    def _model(self, segment: Segment, way: tuple[int, bool]) -> Model:
        rule, is_free = way
        return self.backend.model(segment, rule, self._values, is_free=is_free)

    def recovering(self, segment: Segment, stash: Path) -> Segment:
        """Return a segment with a `recover` line as one that reads the stash file as it is now."""
        histories = read_stash(stash, segment.recover, segment)
        known = self._histories.get(segment.label)
        if known is None or known[2] != len(histories):
            changed, slots = with_recovery(segment, len(histories), self._values)
            known = self._histories[segment.label] = (changed, slots, len(histories))
        changed, slots, samples = known
        for number, slot in enumerate(slots):
            self._values.data[slot : slot + samples] = np.ascontiguousarray(histories[:, number])
        return changed
