"""A program as a model: loaded once, run with other parameters as often as wanted."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

from desire_tui.api.arguments import (
    checked_backend,
    checked_count,
    checked_function,
    checked_lines,
    checked_names,
    checked_timeout,
)
from desire_tui.api.instance import Instance, InstancePool, LoadOptions
from desire_tui.api.interrupts import Interrupts
from desire_tui.api.one_run import one_run
from desire_tui.api.program_source import program_source
from desire_tui.api.run_start import RunStarts
from desire_tui.engine.data_classes import replace
from desire_tui.engine.session.parameters import parameters

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence
    from os import PathLike

    import xarray as xr

    from desire_tui.api.block import Block
    from desire_tui.api.equations import JacobianMatrix, RightHandSide
    from desire_tui.api.run_start import Initial, Number
    from desire_tui.api.sensitive_runs import SensitiveRuns
    from desire_tui.api.simulation import Simulation
    from desire_tui.api.sweep_result import Keep
    from desire_tui.engine.outputs.run import Run
    from desire_tui.engine.session.prepared_run import RunStart
    from desire_tui.engine.source import Source

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
    answers = checked_lines(input)
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
        with Interrupts(), self._pool.one() as first:
            prepared, session = first.prepared, first.session
            start = prepared.start_values()
            known = parameters(prepared.script[0], session.values, start)
            self.parameters = {p.name: p.value for p in known if p.kind != "initial"}
            """Quantities that may be varied, with the values that the script gives them."""
            self.states = dict(prepared.states())
            """All states (elements of arrays one by one) with the values that every run begins with."""
            self.console = first.listener.console
            """What the script wrote on its way to the run."""
        self._starts = RunStarts(source, self.parameters, self.states)

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
        """Make one run, that of the script's first `drun` (or of `load`'s segment), and return its samples.

        What the script does behind it, other runs too, is left out; `desire_tui.run` and `study` do it.
        Keywords and `set` give parameters and starts of states other values for this run; what the script
        computes from them follows. `initial`: states by name or, in the order of `states`, as an array.
        `t`: from when to when. `record`: what is sampled besides the program's own requests: names, elements
        `"A[2]"`, derivatives `"xdot"` or `"d/dt x"`. `check` raises what ends the run early, which is
        `run.error` otherwise. `timeout`: seconds after which it ends. `on_block` is called with new samples
        while it goes on, and ends it by returning False.

        DesireError: the run cannot begin. TypeError, ValueError: the arguments are wrong; an unknown keyword
        is named with the nearest. KeyboardInterrupt: Ctrl-C.
        """
        names = checked_names(record)
        seconds = checked_timeout(timeout)
        checked_function("on_block", on_block)
        with Interrupts(), self._pool.one() as instance:
            settings = self._starts.numbers(set or {}, parameters, instance)
            start = self._starts.start(instance, settings, initial, t, parameters)
            run = one_run(instance, start, names, self._source, timeout=seconds, on_block=on_block)
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

        Each is the run that `run` makes. Programs of several `drun` are for `desire_tui.study`.

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
        names = checked_names(record)
        seconds, kept = checked_timeout(timeout), checked_keep(keep)
        count = checked_count("workers", workers)
        checked_function("progress", progress)
        with Interrupts(), self._pool.one() as instance:
            self._starts.refuse_unknown(parameters, instance, "sweep", _SWEEP_ARGUMENTS)
            grid = grid_of({**(set or {}), **parameters}, lambda v: self._starts.numbers(v, {}, instance))
            first = next(grid.places())
            self._starts.start(instance, first, initial, t, parameters)
            columns = instance.prepared.sampled(names).columns
            if not columns and isinstance(kept, str) and kept != STATE:
                raise ValueError("nothing is recorded: name quantities, record=['x'], or keep='state'")

        def begin(instance: Instance, values: Mapping[str, float]) -> RunStart:
            return self._starts.start(instance, values, initial, t, parameters)

        with Interrupts() as interrupts:
            sweep = Sweep(self._pool, begin, names, kept, self.name, interrupts)
            return sweep.run(grid, count, progress, seconds)

    def start(
        self,
        /,
        *,
        set: Mapping[str, Number] | None = None,  # noqa: A002 - the command line's word
        initial: Initial | None = None,
        t: float | None = None,
        **parameters: Number,
    ) -> Simulation:
        """Return a simulation that goes on from run to run, with snapshots; its arguments are those of `run`.

        `t` is the time at which it begins.
        """
        from desire_tui.api.simulation import Simulation

        with Interrupts():
            instance = self._pool.make()
            settings = self._starts.numbers(set or {}, parameters, instance)
            start = self._starts.start(instance, settings, initial, None, parameters)
        return Simulation(instance, self._starts, self._source, replace(start, t0=t))

    def sensitive_runs(self, parameters: Iterable[str], record: Iterable[str]) -> SensitiveRuns:
        """Return a function that makes runs with the derivatives of what is recorded by some parameters.

        `parameters`: names of parameters, and of states for their initial values. The derivatives are
        integrated along the run: exactly those of the solution, jumps at events included. `runs({"k": 2.0})`
        has `t`, `values` and `derivatives`, an array (parameters, outputs, samples).
        DesireError: a name that is not there.
        """
        from desire_tui.api.sensitive_runs import SensitiveRuns

        made = SensitiveRuns(self._pool, self._starts, parameters, record, self.states)
        with Interrupts(), self._pool.one() as instance:
            names = tuple(name for name in made.parameters if name not in self.states)
            self._starts.way(instance, names, {})
            instance.prepared.sampled(made.record)
        return made

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

        with Interrupts():
            with self._pool.one() as instance:
                self._starts.refuse_unknown(parameters, instance, "equations", ())
            shared = SharedEquations(self._pool.make, self._begin_with, parameters)
        return RightHandSide(shared), JacobianMatrix(shared)

    def _begin_with(self, instance: Instance, parameters: Mapping[str, Any]) -> RunStart:
        settings = self._starts.numbers({}, parameters, instance)
        return self._starts.start(instance, settings, None, None, parameters)
