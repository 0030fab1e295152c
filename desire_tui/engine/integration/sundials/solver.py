"""One CVODE memory with everything that belongs to it."""

from __future__ import annotations

import ctypes
import weakref
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.integration.problem import (
    DOUBT_FAILURE,
    DOUBT_FROM,
    DOUBT_MOST,
    ITERATION_DOUBT_FROM,
    JACOBIAN_SERVES_STEPS,
)
from desire_tui.engine.integration.rules import rule_numbered
from desire_tui.engine.integration.sundials.library import libraries
from desire_tui.engine.integration.sundials.linear import Attached, Linear
from desire_tui.engine.integration.sundials.signatures import ADAMS, BDF, ONE_STEP, SUCCESS

if TYPE_CHECKING:
    from numpy.typing import NDArray

_FAILURES_ALLOWED = 40
"""Failed tests in one step. CVODE's own 7 to 10 are too few where the program's DT is a wild guess."""

MATRIX_CONVERGENCE = 1e-3
"""Share of the error test left to the corrector of BDF with a matrix.

With CVODE's 0.1 what the corrector leaves lets a state that decays toward 0 fall below it: Robertson's
problem at ERMAX = 1e-6 then ran away to -5e7 by t = 1e11, and no flag said so. With 1e-3 the iterations cost
little and the runs take as long or, the steps being longer, half as long."""


class Convergence(NamedTuple):
    """Shares of the error test left to the corrector: as a rule, and from how much doubt on another one."""

    trusted: float
    in_doubt: float
    doubt_from: int = DOUBT_FROM


_DIAGONAL = Convergence(1e-4, 1e-4)
"""CVODE's 0.1 trusts an estimate of the rate of convergence that a diagonal matrix makes far too good:
Robertson's problem then comes out wrong by many times ERMAX, and no flag says so."""
_BDF_MATRIX = Convergence(MATRIX_CONVERGENCE, MATRIX_CONVERGENCE)
_ADAMS_MATRIX = Convergence(6e-2, MATRIX_CONVERGENCE)
"""With CVODE's 0.1 throughout solutions went through the singularity of `d/dt y = -1/(2*y)` unseen, and with
0.07 and more Van der Pol's equation is wrong by 40 ERMAX at one in a hundred values of ERMAX; with 1e-3
throughout HIRES and Robertson's problem take twice the evaluations for the same accuracy."""
_ITERATION = Convergence(7e-2, 2e-2, ITERATION_DOUBT_FROM)
"""Functional iteration's estimate of its own convergence is coarse where it is slow, in stiff models: with
0.03 and more throughout the ring modulator comes out wrong by more than 10 ERMAX, with this by 0.03 (Adams)
and 0.01 (BDF). With CVODE's 0.1 Adams' method creeps: what the corrector leaves keeps its steps at a tenth,
none of which fails (Van der Pol's equation, one in three values of ERMAX). Where nothing is stiff the
corrector hardly fails: an orbit takes up to a third fewer evaluations than with 0.02."""


@dataclass(frozen=True)
class Callbacks:
    """Addresses of C functions (CVRhsFn, CVEwtFn) and of the structure handed to them."""

    rhs: int
    weights: int
    user: int = 0


@dataclass(frozen=True)
class Counts:
    """What CVODE did since its last restart."""

    steps: int
    failed: int
    """Steps tried again: error tests failed and corrector iterations that did not converge."""
    order: int


class Solver:
    """CVODE for `n` states at `states` (an address: the solution is written there, nothing is copied).

    States inside the last step go to `between`.

    `rule` is a multistep one. Start it with `restart`, then call `step` again and again, or let
    native code call `CVode` with `memory` and `vector`.
    """

    def __init__(
        self, rule: int, n: int, states: int, callbacks: Callbacks, linear: Linear, between: int = 0
    ) -> None:
        is_adams = rule_numbered(rule).solver == "Adams"
        self.n = n
        self._library = library = libraries().cvode
        core = libraries().core
        context = ctypes.c_void_p()
        core.SUNContext_Create(0, ctypes.byref(context))
        core.SUNContext_ClearErrHandlers(context)  # they would write to the terminal; flags say enough
        self.vector: int = library.N_VMake_Serial(n, states, context)
        self.between: int = library.N_VMake_Serial(n, between or states, context)
        self.memory: int = library.CVodeCreate(ADAMS if is_adams else BDF, context)
        parts = _Parts(core, library, context, self.memory, (self.vector, self.between))
        self._free = weakref.finalize(self, parts.free)
        self._set("CVodeInit", callbacks.rhs, 0.0, self.vector)
        self._set("CVodeSetUserData", callbacks.user)
        self._set("CVodeWFtolerances", callbacks.weights)
        self._set("CVodeSetMaxNumSteps", -1)  # one step a call, as many as it takes
        self._set("CVodeSetMaxErrTestFails", _FAILURES_ALLOWED)
        self._set("CVodeSetMaxConvFails", _FAILURES_ALLOWED)
        self._set("CVodeSetMaxHnilWarns", -1)
        self.convergence = _convergence(linear, is_adams=is_adams)
        self._set("CVodeSetNonlinConvCoef", self.convergence.trusted)
        parts.attached = Attached(libraries(), context, self.memory, self.vector, n, linear)
        self._reached = ctypes.c_double()
        self._has_matrix = linear.kind not in {"diagonal", "fixed-point"}
        self._diverged = self._doubt = 0

    def free(self) -> None:
        """Give everything back now (also done when the object goes)."""
        self._free()

    def limit(self, dt_max: float, dt_min: float = 0.0) -> None:
        """Set the largest step, 0 for none, and the smallest."""
        self._set("CVodeSetMinStep", 0.0)
        self._set("CVodeSetMaxStep", max(dt_max, 0.0))
        self._set("CVodeSetMinStep", dt_min)

    def restart(self, t: float, first_step: float) -> None:
        """Begin anew, order 1, from the states at `states`."""
        self._set("CVodeReInit", t, self.vector)
        self._set("CVodeSetInitStep", first_step)
        self._diverged = self._doubt = 0
        self._trust(is_trusted=True)

    def step(self, t_stop: float) -> tuple[int, float]:
        """Take one step, never beyond `t_stop`; return CVODE's flag (< 0: failed) and the time reached."""
        self._set("CVodeSetStopTime", t_stop)
        reached = self._reached
        flag = self._library.CVode(self.memory, t_stop, self.vector, ctypes.byref(reached), ONE_STEP)
        self._be_in_doubt(self._count("CVodeGetNumStepSolveFails"))
        return flag, reached.value

    def _be_in_doubt(self, failures: int) -> None:
        """Hold the corrector to more while it is in doubt (`integration.problem`)."""
        before, self._diverged = self._diverged, failures
        self._doubt = min(self._doubt + DOUBT_FAILURE * (failures - before), DOUBT_MOST)
        is_large = self._doubt > self.convergence.doubt_from
        self._doubt = max(self._doubt - 1, 0)
        if is_large:
            self._trust(is_trusted=self._doubt <= self.convergence.doubt_from)

    def _trust(self, *, is_trusted: bool) -> None:
        convergence = self.convergence
        self._set("CVodeSetNonlinConvCoef", convergence.trusted if is_trusted else convergence.in_doubt)
        if self._has_matrix:
            self._set("CVodeSetJacEvalFrequency", JACOBIAN_SERVES_STEPS if is_trusted else 1)

    def interpolate(self, t: float) -> None:
        """Write the states at a time inside the last step to `between`."""
        self._set("CVodeGetDky", t, 0, self.between)

    @property
    def last_step(self) -> float:
        """Size of the last step taken."""
        return self._number("CVodeGetLastStep")

    def counts(self) -> Counts:
        """Return what was done since the last restart."""
        steps, rhs, fails = ctypes.c_long(), ctypes.c_long(), ctypes.c_long()
        order, setups, next_order = ctypes.c_int(), ctypes.c_long(), ctypes.c_int()
        unused = [ctypes.c_double() for _ in range(4)]
        counted = (steps, rhs, setups, fails, order, next_order)
        self._set("CVodeGetIntegratorStats", *map(ctypes.byref, counted), *map(ctypes.byref, unused))
        diverged = self._count("CVodeGetNumStepSolveFails")
        return Counts(steps.value, fails.value + diverged, order.value)

    def worst_state(self) -> int:
        """Return the number of the state with the largest weighted error estimate in the last try."""
        errors, weights = np.zeros(self.n), np.zeros(self.n)
        self._fetch("CVodeGetEstLocalErrors", errors)
        self._fetch("CVodeGetErrWeights", weights)
        return int(np.argmax(np.nan_to_num(np.abs(errors * weights), nan=np.inf)))

    def _set(self, name: str, *arguments: object) -> None:
        flag = getattr(self._library, name)(self.memory, *arguments)
        assert flag == SUCCESS, f"{name}{arguments} refused: {flag}"

    def _number(self, name: str) -> float:
        value = ctypes.c_double()
        self._set(name, ctypes.byref(value))
        return value.value

    def _count(self, name: str) -> int:
        value = ctypes.c_long()
        self._set(name, ctypes.byref(value))
        return value.value

    def _fetch(self, name: str, out: NDArray[np.float64]) -> None:
        context = ctypes.cast(self.vector, ctypes.POINTER(ctypes.c_void_p))[2]  # {content, ops, sunctx}
        vector = self._library.N_VMake_Serial(self.n, out.ctypes.data, context)
        self._set(name, vector)
        self._library.N_VDestroy_Serial(vector)


def _convergence(linear: Linear, *, is_adams: bool) -> Convergence:
    if linear.kind == "diagonal":
        return _DIAGONAL
    if linear.kind == "fixed-point":
        return _ITERATION
    return _ADAMS_MATRIX if is_adams else _BDF_MATRIX


class _Parts:
    """What must be given back, in order; keeps no reference to the solver, which can thus be collected."""

    def __init__(
        self,
        core: ctypes.CDLL,
        library: ctypes.CDLL,
        context: ctypes.c_void_p,
        memory: int,
        vectors: tuple[int, ...],
    ) -> None:
        self._core, self._library, self._context = core, library, context
        self._memory, self._vectors = memory, vectors
        self.attached: Attached | None = None

    def free(self) -> None:
        memory = ctypes.c_void_p(self._memory)
        self._library.CVodeFree(ctypes.byref(memory))
        if self.attached is not None:
            self.attached.free()
        for vector in self._vectors:
            self._library.N_VDestroy_Serial(vector)
        self._core.SUNContext_Free(ctypes.byref(self._context))
