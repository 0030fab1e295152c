"""A model's right-hand side and Jacobian as functions, for solvers of other people."""

from __future__ import annotations

import ctypes
from threading import Lock
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numpy.typing import ArrayLike, NDArray

    from desire_tui.api.instance import Instance
    from desire_tui.engine.runtime.equations import Equations
    from desire_tui.engine.session.prepared_run import RunStart

    Floats = NDArray[np.float64]
    Begin = Callable[[Instance, Mapping[str, Any]], RunStart]
    """Returns what a run with these parameters begins with."""

C_FUNCTION = ctypes.CFUNCTYPE(
    ctypes.c_int, ctypes.c_double, ctypes.POINTER(ctypes.c_double), ctypes.POINTER(ctypes.c_double),
    ctypes.c_void_p,
)  # fmt: skip
"""`int f(double t, const double *x, double *result, void *unused)`; 0, or 1 if a result is not finite."""


class _Ready(NamedTuple):
    """An instance where a run begins, and its derivatives as functions."""

    instance: Instance
    equations: Equations
    parameters: dict[str, Any]


class SharedEquations:
    """What both functions of a model share: an instance for its own parameters, and one for others."""

    def __init__(self, make: Callable[[], Instance], begin: Begin, parameters: Mapping[str, Any]) -> None:
        self._make, self._begin = make, begin
        self.parameters = dict(parameters)
        self.lock = Lock()
        self._varied: _Ready | None = None
        self._own = self._ready(make(), self.parameters)
        prepared = self._own.instance.prepared
        self.states = tuple(name for name, _ in prepared.states())
        self.start = prepared.state()
        self.has_events = bool(prepared.segment.events)

    def _ready(self, instance: Instance, parameters: Mapping[str, Any]) -> _Ready:
        start = self._begin(instance, parameters)
        instance.prepared.begin(start)
        return _Ready(instance, instance.prepared.equations(), dict(parameters))

    def at(self, parameters: Mapping[str, Any]) -> Equations:
        """Return the functions with these parameters besides the own ones; hold `lock`."""
        if not parameters:
            return self._own.equations
        ready = self._varied
        if ready is not None and ready.parameters == parameters:
            return ready.equations
        if ready is None:
            ready = self._ready(self._make(), {**self.parameters, **parameters})
        else:
            instance, before = ready.instance, ready.instance.prepared
            start = self._begin(instance, {**self.parameters, **parameters})  # it may run the script anew
            instance.prepared.begin(start)
            if instance.prepared is not before:  # the script ran anew
                ready = ready._replace(equations=instance.prepared.equations())
        self._varied = ready._replace(parameters=dict(parameters))
        return ready.equations

    def places(self, t: ArrayLike, x: Floats) -> tuple[Floats, Floats]:
        """Return m times and m by n states from one or m times and n by m states. ValueError: wrong shape."""
        n = len(self.states)
        if x.ndim != 2 or x.shape[0] != n:
            raise ValueError(f"x has shape {x.shape}, but the model has {n} states")
        times = np.ascontiguousarray(np.broadcast_to(np.asarray(t, dtype=np.float64), x.shape[1:]))
        return times, np.ascontiguousarray(x.T)

    def address(self, number: int) -> int:
        """Return a C function's address. RuntimeError: the back end has none."""
        addresses = self._own.equations.addresses
        if addresses is None:
            raise RuntimeError("the reference back end has no machine code, so no address")
        return addresses[number]


class _Function:
    """`f(t, x)`, and the same as C code."""

    _number = 0

    def __init__(self, shared: SharedEquations) -> None:
        self._shared = shared

    @property
    def states(self) -> tuple[str, ...]:
        """Names of the states, in the order of `x`."""
        return self._shared.states

    @property
    def has_events(self) -> bool:
        """Whether the model has `event` or `every` blocks besides, which the function knows nothing of."""
        return self._shared.has_events

    @property
    def start(self) -> Floats:
        """The states that a run begins with."""
        return self._shared.start.copy()

    @property
    def address(self) -> int:
        """Where the machine code is: `int f(double t, const double *x, double *result, void *unused)`.

        It returns 0, or 1 if a result is not finite; `result` gets n numbers, or a Jacobian's n by n, row
        after row. To be called from one thread at a time, as long as this object lives.
        RuntimeError: the reference back end has none.
        """
        return self._shared.address(self._number)

    @property
    def ctypes(self) -> Any:
        """The C function for `ctypes`, numba and `scipy.LowLevelCallable`; see `address`."""
        function = C_FUNCTION(self.address)
        function._equations = self._shared  # type: ignore[attr-defined]  # noqa: SLF001 - keeps the code
        return function

    def _place(self, x: ArrayLike) -> Floats:
        place = np.asarray(x, dtype=np.float64)
        if place.shape != (len(self._shared.states),):
            raise ValueError(
                f"x has shape {place.shape}, but the model has {len(self._shared.states)} states"
            )
        return place


class RightHandSide(_Function):
    """dx/dt as a function of t and the states, for `scipy.integrate.solve_ivp` and others."""

    def __call__(self, t: ArrayLike, x: ArrayLike, /, **parameters: Any) -> Floats:
        """Return dx/dt, in the shape of `x`: n numbers, or n by m for m places at once (t one or m times).

        Keywords give parameters other values. ValueError: wrong shape; TypeError: no such parameter.
        """
        shared = self._shared
        place = np.asarray(x, dtype=np.float64)
        if place.shape == (len(shared.states),):
            with shared.lock:
                return shared.at(parameters).derivatives(float(t), place)  # type: ignore[arg-type]
        times, places = shared.places(t, place)
        with shared.lock:
            return shared.at(parameters).many(times, places).T

    def __repr__(self) -> str:
        return f"<dx/dt of {len(self.states)} states as f(t, x)>"


class JacobianMatrix(_Function):
    """The matrix ∂(dx/dt)/∂x as a function of t and the states, exact where dx/dt can be differentiated."""

    _number = 1

    def __call__(self, t: ArrayLike, x: ArrayLike, /, **parameters: Any) -> Floats:
        """Return the matrix, n by n: element [i, k] is the derivative of dx_i/dt by x_k.

        For m places at once, `x` n by m, m matrices: m by n by n (t one or m times).
        """
        shared = self._shared
        if np.ndim(x) == 2:
            times, places = shared.places(t, np.asarray(x, dtype=np.float64))
            with shared.lock:
                return shared.at(parameters).jacobians(times, places)
        place = self._place(x)
        with shared.lock:
            return shared.at(parameters).jacobian(float(t), place)  # type: ignore[arg-type]

    def sparse(self, t: float, x: ArrayLike, /, **parameters: Any) -> Any:
        """Return the matrix as a `scipy.sparse.csc_array`, for models of many states."""
        place = self._place(x)
        with self._shared.lock:
            equations = self._shared.at(parameters)
            return _csc(equations, equations.entries(float(t), place))

    @property
    def sparsity(self) -> Any:
        """Where it may differ from 0, as a `scipy.sparse.csc_array` of ones: for `jac_sparsity=`."""
        with self._shared.lock:
            equations = self._shared.at({})
            return _csc(equations, np.ones(equations.pattern.count))

    def __repr__(self) -> str:
        return f"<Jacobian of {len(self.states)} states as J(t, x)>"


def _csc(equations: Equations, entries: Floats) -> Any:
    from scipy.sparse import csc_array

    pattern = equations.pattern
    return csc_array((entries, pattern.rows, pattern.starts), shape=(pattern.n, pattern.n))
