"""`continue`: steady states, cycles, folds and Hopf points followed over one or two parameters."""

from __future__ import annotations

from time import monotonic
from typing import TYPE_CHECKING, NoReturn

import numpy as np

from desire_tui.analysis.continuation.branches import Diagram
from desire_tui.analysis.continuation.cycles_diagram import CyclesTracer
from desire_tui.analysis.continuation.equilibria_diagram import EquilibriaTracer
from desire_tui.analysis.continuation.equilibrium_curve import EquilibriumCurve
from desire_tui.analysis.continuation.report import Report
from desire_tui.analysis.continuation.request import read
from desire_tui.analysis.continuation.settled import from_run
from desire_tui.analysis.continuation.two_parameters import KINDS, is_passed, trace
from desire_tui.analysis.equilibria.flow import Flow
from desire_tui.analysis.equilibria.influence import USEFUL, has_influence
from desire_tui.analysis.equilibria.search import search
from desire_tui.analysis.equilibria.starts import Travelled, spread
from desire_tui.analysis.equilibria.system import System
from desire_tui.engine.diagnostics import DesireError, Diagnostic

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.analysis.continuation.equilibrium_curve import Range
    from desire_tui.analysis.continuation.request import Asked
    from desire_tui.analysis.progress import Progress
    from desire_tui.analysis.result import Result
    from desire_tui.analysis.subject import Subject

    Floats = NDArray[np.float64]

_STARTS = 32
_DRAWN_EVERY = 0.5
_PARTS = (0.0, 0.37, 1.0)
"""Where in its range a parameter's influence is looked for."""


def analyse(subject: Subject, request: str, progress: Progress) -> Result:
    """Follow what is asked and return the diagram.

    DesireError 520: the request is wrong; 521: there is nothing to follow, or the parameter has no influence;
    491: see `Flow`.
    """
    asked = read(request, subject.model.parameters, subject.model.states)
    progress(None, "run")
    with np.errstate(all="ignore"):  # what runs off is looked for, and told in words
        return _Continuation(subject, asked, progress).result()


class _Continuation:
    def __init__(self, subject: Subject, asked: Asked, progress: Progress) -> None:
        self._subject, self._asked, self._progress = subject, asked, progress
        self._flow = flow = Flow(subject)
        self._travelled = travelled = Travelled(subject)
        values = [{one.name: end} for one in asked.over for end in (one.low, one.high)]
        self._system = System(flow, travelled.start, travelled.size, values)
        for one in asked.over:
            self._refuse_useless(one)
        self._over = asked.over[0]
        value = flow.parameters[self._over.name]
        self._value = min(max(value, self._over.low), self._over.high)
        self._diagram = Diagram()
        if self._value != value:
            self._diagram.notes.append(
                f"{self._over.name} = {value:g} is not in the range: it begins at {self._value:g}"
            )
        self._curve = EquilibriumCurve(self._system, self._over, self._over.part(self._value))
        title = f"{', '.join(one.name for one in asked.over)} continued, {subject.name}"
        self._report = Report(title, self._system, asked.over, travelled.shown)
        self._drawn = monotonic()

    def result(self) -> Result:
        """Do it."""
        if len(self._asked.over) == 2:
            return self._two_parameters()
        if self._asked.origin == "cycle":
            self._cycle()
        else:
            self._steady_states()
            if self._asked.has_cycles and not self._diagram.is_partial:
                CyclesTracer(self._curve, self._diagram, self._go_on).trace()
        return self._report.result(self._diagram)

    def _refuse_useless(self, one: Range) -> None:
        values = [one.value(part) for part in _PARTS]
        if not has_influence(self._flow, self._system.size, one.name, values):
            self._fail(f"{one.name} has no influence on the derivatives", USEFUL)

    def _steady_states(self) -> None:
        starts = self._starts()
        p = {self._over.name: self._value}
        found = search(self._system, starts, p, lambda count: self._progress(None, f"{count} starts"))
        if not found.states:
            self._fail(
                f"no steady state is found at {self._over.name} = {self._value:g}, from {len(starts)} "
                f"start{'s' * (len(starts) != 1)}",
                "look for one with `steady all in …`, and begin there: from x = 1, y = 2",
            )
        if found.is_family:
            self._diagram.notes.append(
                "at each value of the parameter the steady states are points of a curve: one is followed"
            )
        self._diagram.is_partial = found.is_partial
        states = found.states[:1] if found.is_family else found.states
        tracer = EquilibriaTracer(self._curve, self._diagram, self._go_on_to_wanted)
        tracer.trace([s.z for s in states], self._over.part(self._value))

    def _starts(self) -> list[Floats]:
        flow, travelled, asked = self._flow, self._travelled, self._asked
        if asked.origin in ("here", "place"):
            given = asked.place or self._subject.here or {}
            return [np.array([given.get(n, x) for n, x in zip(flow.names, flow.start.tolist(), strict=True)])]
        return [travelled.end, travelled.start, *spread(*travelled.box(), _STARTS)]

    def _cycle(self) -> None:
        travelled = self._travelled
        begun = from_run(
            self._system, self._over, self._over.part(self._value), travelled.end, travelled.duration,
            lambda: self._progress(None, "looking for the cycle of the run"),
        )  # fmt: skip
        if isinstance(begun, str):
            self._fail(
                f"no cycle is found at {self._over.name} = {self._value:g}: {begun}",
                "a longer run (TMAX), or another value of the parameter",
            )
        CyclesTracer(self._curve, self._diagram, self._go_on_to_wanted).both_ways(*begun, "run")

    def _two_parameters(self) -> Result:
        wanted, kinds = self._asked.special, KINDS[:2]
        if self._asked.origin == "cycle":
            self._cycle()
            kinds = KINDS[2:]
        else:
            self._steady_states()
            if wanted is not None and wanted[0] in KINDS[2:] and not self._diagram.is_partial:
                CyclesTracer(self._curve, self._diagram, self._go_on_to_wanted).trace()
                kinds = KINDS
        found = [s for s in self._diagram.specials if s.kind in kinds]
        chosen = [s for s in found if wanted is None or (s.kind, s.number) == wanted]
        if not chosen:
            seen = ", ".join(f"{s.kind} {s.number}" for s in found) or f"no {' and no '.join(kinds)}"
            missing = "there is nothing to follow"
            if wanted is not None:
                missing = f"{wanted[0]} {wanted[1]} is not found"
            self._fail(
                f"{missing} over {self._over.name}: there is {seen}", f"continue {self._over.name} in …"
            )
        second = self._asked.over[1]
        value = self._flow.parameters[second.name]
        plane = Diagram(notes=self._diagram.notes)
        if not second.low <= value <= second.high:
            self._fail(
                f"{second.name} = {value:g} is not in its range, where the curves begin",
                f"{second.name} in [{min(second.low, value):g}, {max(second.high, value):g}]",
            )
        self._diagram = plane
        for special in chosen:
            if plane.is_partial:
                break
            if is_passed(plane, special, second.part(value)):
                continue
            trace(self._system, (self._over, second), value, special, plane, self._go_on)
        return self._report.result(plane)

    def _go_on_to_wanted(self, told: str) -> bool:
        """Go on until the point is found that is to be followed over two parameters, if it is one."""
        wanted = self._asked.special
        found = wanted is not None and any((s.kind, s.number) == wanted for s in self._diagram.specials)
        return not found and self._go_on(told)

    def _go_on(self, told: str) -> bool:
        so_far = None
        if self._is_shown and monotonic() - self._drawn > _DRAWN_EVERY:
            so_far = self._report.result(self._diagram)
            self._drawn = monotonic()
        return self._progress(None, told, so_far)

    @property
    def _is_shown(self) -> bool:
        """Whether what is found belongs to the answer already."""
        kinds = set(KINDS) if len(self._asked.over) == 2 else {"steady", "cycle"}
        return bool(self._diagram.branches) and {b.kind for b in self._diagram.branches} <= kinds

    def _fail(self, what: str, remedy: str) -> NoReturn:
        facts = {"what": what, "remedy": remedy}
        raise DesireError(Diagnostic("analysis-failed", None, facts, self._subject.source))
