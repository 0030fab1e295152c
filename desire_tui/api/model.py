"""A program as a model: loaded once, run with other parameters as often as wanted."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from math import inf
from time import monotonic
from typing import TYPE_CHECKING, Any

import numpy as np

from desire_tui.api.arguments import checked_backend, checked_timeout, checked_workers, refuse_name
from desire_tui.api.instance import Instance, InstancePool, LoadOptions, Way
from desire_tui.api.program_source import program_source
from desire_tui.api.settings import name_problems, numbers, slot_of, way_of
from desire_tui.engine.diagnostics import DesireError, Diagnostic, closest
from desire_tui.engine.outputs.results import run_data
from desire_tui.engine.session.prepared_run import RunStart

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence
    from os import PathLike

    import xarray as xr
    from numpy.typing import ArrayLike, NDArray

    from desire_tui.api.equations import JacobianMatrix, RightHandSide
    from desire_tui.api.sweep_result import Keep
    from desire_tui.engine.outputs.run import Run
    from desire_tui.engine.runtime.run_record import RunRecord
    from desire_tui.engine.source import Source

    Number = float | ArrayLike
    Initial = Mapping[str, Number] | NDArray[np.float64] | Sequence[float]

_RUN_ARGUMENTS = ("set", "initial", "t", "record", "check", "timeout", "on_block")
_SWEEP_ARGUMENTS = ("set", "initial", "t", "record", "keep", "workers", "progress", "timeout")


def load(
    program: str | PathLike[str],
    *,
    segment: str | None = None,
    input: Iterable[str] = (),  # noqa: A002 - the command line's word
    backend: str = "native",
    allow_shell: bool = False,
    allow_write: bool = False,
) -> Model:
    """See `desire_tui.load`."""
    answers = tuple(input)
    options = LoadOptions(segment, answers, checked_backend(backend), allow_shell, allow_write)
    return Model(program_source(program), options)


class Model:
    """A program brought to its first `drun`, which can be made again and again, from several threads at once.

    Each run begins where the script came to that `drun`, with the values given in place of the script's own.
    """

    def __init__(self, source: Source, options: LoadOptions) -> None:
        self.name = source.name
        self._source = source
        self._pool = InstancePool(lambda: Instance(source, options))
        with self._pool.one() as first:
            prepared, session = first.prepared, first.session
            start = prepared.start_values()
            from desire_tui.engine.session.parameters import parameters

            known = parameters(prepared.script[0], session.values, start)
            self.parameters = {p.name: p.value for p in known if p.kind != "initial"}
            """Quantities that may be varied, with the values that the script gives them."""
            self.states = dict(prepared.states())
            """All states (elements of arrays one by one) with the values that every run begins with."""
            self.console = first.listener.console
            """What the script wrote on its way to the run."""

    def __repr__(self) -> str:
        count = len(self.states)
        states = ", ".join(list(self.states)[:6]) + (", …" if count > 6 else "")
        values = [f"{name}={value:g}" for name, value in list(self.parameters.items())[:8]]
        shown = ", ".join(values) + (", …" if len(self.parameters) > 8 else "")
        return (
            f"<Model {self.name}: {count} state{'s' * (count != 1)} {states}; "
            f"{f'parameters {shown}' if shown else 'no parameters'}>"
        )

    def run(
        self,
        /,
        *,
        set: Mapping[str, Number] | None = None,  # noqa: A002 - the command line's word
        initial: Initial | None = None,
        t: tuple[float, float] | None = None,
        record: str | Iterable[str] = (),
        check: bool = False,
        timeout: float | None = None,
        on_block: Callable[[Block], object] | None = None,
        **parameters: Number,
    ) -> Run:
        """Make one run and return its samples."""
        names = (record,) if isinstance(record, str) else tuple(record)
        seconds = checked_timeout(timeout)
        with self._pool.one() as instance:
            settings = self._numbers(set or {}, parameters, instance)
            start = self._start(instance, settings, initial, t, parameters)
            control, observer = instance.session.control, _Blocks(on_block, instance)
            control.deadline = inf if seconds is None else monotonic() + seconds
            made, error = instance.prepared.run(start, names, observer)
            if made.ended == "stopped" and monotonic() > control.deadline:
                error = DesireError(Diagnostic("time-limit", None, {"seconds": seconds}, self._source))
            run = run_data(
                made, more=True, program=self.name, state=instance.prepared.state(), error=error,
                warnings=tuple(instance.prepared.warnings),
            )  # fmt: skip
        return run.check() if check else run

    def sweep(
        self,
        /,
        *,
        set: Mapping[str, Number] | None = None,  # noqa: A002 - the command line's word
        initial: Initial | None = None,
        t: tuple[float, float] | None = None,
        record: str | Iterable[str] = (),
        keep: Keep = "curves",
        workers: int | None = None,
        progress: Callable[[int, int], object] | None = None,
        timeout: float | None = None,
        **parameters: Number | Sequence[float],
    ) -> xr.Dataset:
        """Make a run for every combination of the values listed, and return all of them over the parameters.

        Parameters with a list are the dimensions, in the order given; those with a number hold for all runs.
        `keep`: `curves` (samples over `t`), `last`, `max`, `min` or `mean` of each curve, `state` (all states
        at the end), or a function of a `Run` that returns a number, an array, or a mapping from names to
        such. A run that fails is NaN, and `message` says why. `workers`: so many threads, by default as many
        as pay; `progress(done, total)` is called in this thread, ten times a second; `timeout` is a run's.

        ImportError: xarray is missing (`pip install 'desire-tui[data]'`). TypeError, ValueError: as `run`.
        """
        from desire_tui.api.sweep import Sweep, grid_of
        from desire_tui.api.sweep_result import STATE, checked_keep
        from desire_tui.engine.outputs.tables import needed

        needed("xarray")
        names = (record,) if isinstance(record, str) else tuple(record)
        seconds, kept = checked_timeout(timeout), checked_keep(keep)
        count = checked_workers(workers)
        with self._pool.one() as instance:
            self._refuse_unknown(parameters, instance, "sweep", _SWEEP_ARGUMENTS)
            grid = grid_of({**(set or {}), **parameters}, lambda v: self._numbers(v, {}, instance))
            first = next(grid.places())
            self._start(instance, first, initial, t, parameters)
            columns = instance.prepared.sampled(names).columns
            if not columns and isinstance(kept, str) and kept != STATE:
                raise ValueError("nothing is recorded: name quantities, record=['x'], or keep='state'")

        def begin(instance: Instance, values: Mapping[str, float]) -> RunStart:
            return self._start(instance, values, initial, t, parameters)

        return Sweep(self._pool, begin, names, kept, self.name).run(grid, count, progress, seconds)

    # ------------------------------------------------------------------ for other people's solvers

    @property
    def rhs(self) -> RightHandSide:
        """dx/dt as a compiled function of t and the states: `solve_ivp(model.rhs, …)`.

        DesireError 491: the derivatives depend on the past or on random numbers, or there are none. What
        SAMPLE, `step` and events set stays as the script left it.
        """
        return self._equations[0]

    @property
    def jacobian(self) -> JacobianMatrix:
        """The derivatives of dx/dt by the states as a compiled function: `jac=model.jacobian`."""
        return self._equations[1]

    @cached_property
    def _equations(self) -> tuple[RightHandSide, JacobianMatrix]:
        return self.equations()

    def equations(self, /, **parameters: Number) -> tuple[RightHandSide, JacobianMatrix]:
        """Return `rhs` and `jacobian` with other parameters, and C addresses of their own."""
        from desire_tui.api.equations import JacobianMatrix, RightHandSide, SharedEquations

        with self._pool.one() as instance:
            self._refuse_unknown(parameters, instance, "equations", ())
        shared = SharedEquations(self._pool.make, self._begin_with, parameters)
        return RightHandSide(shared), JacobianMatrix(shared)

    def _begin_with(self, instance: Instance, parameters: Mapping[str, Any]) -> RunStart:
        settings = self._numbers({}, parameters, instance)
        return self._start(instance, settings, None, None, parameters)

    # ------------------------------------------------------------------ what a run begins with

    def _start(
        self,
        instance: Instance,
        settings: Mapping[str, float],
        initial: Initial | None,
        t: tuple[float, float] | None,
        keywords: Mapping[str, Any],
    ) -> RunStart:
        way = self._way(instance, tuple(settings), keywords)
        if way.slots is None:
            instance.override(settings)
            assignments: list[tuple[int, float]] = []
        else:
            instance.override({})
            assignments = list(zip(way.slots, settings.values(), strict=True))
        t0, t1 = (None, None) if t is None else _span(t)
        follow = way.follow if way.slots is not None else None
        return RunStart(assignments, follow, self._initial(instance, initial), t0, t1)

    def _numbers(
        self, values: Mapping[str, Any], keywords: Mapping[str, Any], instance: Instance
    ) -> dict[str, float]:
        try:
            return numbers({**values, **keywords})
        except (TypeError, ValueError):  # of an argument that is misspelt: the name is what is wrong
            self._refuse_unknown(keywords, instance)
            raise

    def _way(self, instance: Instance, names: tuple[str, ...], keywords: Mapping[str, Any]) -> Way:
        way = instance.ways.get(names)
        if way is None:
            instance.override({})
            self._refuse_unknown(keywords, instance)
            way = way_of(names, instance)
            instance.ways[names] = way
        return way

    def _refuse_unknown(
        self,
        keywords: Mapping[str, object],
        instance: Instance,
        function: str = "run",
        arguments: tuple[str, ...] = _RUN_ARGUMENTS,
    ) -> None:
        """TypeError: keywords that are neither arguments of a function nor names of the program."""
        for problem in name_problems(keywords, instance):
            if problem.key == "set-unknown":
                known = [*arguments, *self.parameters, *self.states]
                refuse_name(function, "parameter or setting", str(problem.facts["name"]), known)

    def _initial(self, instance: Instance, initial: Initial | None) -> list[tuple[int, float]]:
        if initial is None:
            return []
        if not isinstance(initial, Mapping):
            array = np.asarray(initial, dtype=np.float64)
            if array.shape != (len(self.states),):
                raise ValueError(
                    f"initial has shape {array.shape}, but the model has {len(self.states)} states"
                )
            return list(zip(instance.prepared.state_slots().tolist(), array.tolist(), strict=True))
        found = []
        for name, value in numbers(initial).items():
            slot = slot_of(name, instance) if name in self.states else None
            if slot is None:
                facts = {"name": name, "close": closest(name, self.states)}
                raise DesireError(Diagnostic("initial-unknown", None, facts, self._source))
            found.append((slot, value))
        return found


def _span(t: tuple[float, float]) -> tuple[float, float]:
    try:
        first, last = map(float, t)
    except (TypeError, ValueError):
        raise TypeError(f"t is a pair of times, (0, 10), not {t!r}") from None
    return first, last


class Block:
    """New samples of a run that goes on: a mapping from names to arrays, `t` among them."""

    def __init__(self, record: RunRecord, first: int) -> None:
        self._record, self._first = record, first

    @property
    def t(self) -> NDArray[np.float64]:
        """Times of the samples."""
        return self["t"]

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        record = self._record
        samples = record.t if name == "t" else record.values(name)
        return samples[self._first :].copy()

    def keys(self) -> list[str]:
        """Return the names of what is recorded."""
        return ["t", *dict.fromkeys(column.name for column in self._record.columns if column.name != "t")]

    def __iter__(self) -> Any:
        return iter(self.keys())

    def __len__(self) -> int:
        return len(self.keys())


class _Blocks:
    """Hands blocks of samples on; False ends the run."""

    def __init__(self, on_block: Callable[[Block], object] | None, instance: Instance) -> None:
        self._on_block, self._instance = on_block, instance

    def block(self, record: RunRecord, first_row: int) -> None:
        """Note new samples."""
        if self._on_block is not None and self._on_block(Block(record, first_row)) is False:
            self._instance.prepared.end()
