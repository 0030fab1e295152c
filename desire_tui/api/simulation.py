"""A model that goes on from run to run, with snapshots to go back to."""

from __future__ import annotations

from threading import Lock
from typing import TYPE_CHECKING, Any

from desire_tui.api.arguments import checked_function, checked_names, checked_timeout
from desire_tui.api.interrupts import Interrupts, watch
from desire_tui.api.one_run import one_run
from desire_tui.api.settings import way_of
from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.session.prepared_run import RunStart
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    import numpy as np
    from numpy.typing import NDArray

    from desire_tui.api.block import Block
    from desire_tui.api.instance import Instance, Way
    from desire_tui.api.run_start import Number, RunStarts
    from desire_tui.engine.outputs.run import Run
    from desire_tui.engine.session.checkpoint import Checkpoint
    from desire_tui.engine.source import Source

_RUN_ARGUMENTS = ("set", "record", "check", "timeout", "on_block")


@dataclass(frozen=True, eq=False, repr=False)
class Snapshot:
    """All that a simulation goes on from: quantities, random numbers, delays, stored histories."""

    t: float
    _of: Simulation
    _begun: bool
    _checkpoint: Checkpoint

    def __repr__(self) -> str:
        return f"<Snapshot at t = {self.t:g}>"


class Simulation:
    """Runs of a model that continue one another, as `drun` after `drun` in a script does.

    Made by `Model.start`. One thread at a time.
    """

    def __init__(self, instance: Instance, starts: RunStarts, source: Source, start: RunStart) -> None:
        self._instance, self._starts, self._source = instance, starts, source
        self._prepared = instance.prepared
        self._lock = Lock()
        self._ways: dict[tuple[str, ...], Way] = {}
        self._begun = False
        self._prepared.begin(start)
        self._here = self._prepared.checkpoint()

    def __repr__(self) -> str:
        return f"<Simulation of {self._source.name} at t = {self.t:g}>"

    @property
    def t(self) -> float:
        """The time it has reached."""
        values = self._prepared.values
        return float(values.cells[T]) if values.defined[T] else 0.0

    @property
    def state(self) -> NDArray[np.float64]:
        """All states as they are now, in the order of `Model.states`."""
        return self._prepared.state()

    def __getitem__(self, name: str) -> float | NDArray[Any]:
        """Return a quantity's present value, an array in its shape. KeyError: there is none."""
        values = self._prepared.values
        quantity = values.find(name)
        if quantity is None or not values.is_defined(quantity):
            raise KeyError(name)
        return values.view(quantity).copy() if quantity.shape else float(values.cells[quantity.slot])

    def run(
        self,
        duration: float | None = None,
        /,
        *,
        set: Mapping[str, Number] | None = None,  # noqa: A002 - the command line's word
        record: str | Iterable[str] = (),
        check: bool = False,
        timeout: float | None = None,
        on_block: Callable[[Block], object] | None = None,
        **parameters: Number,
    ) -> Run:
        """Go on for a duration, by default TMAX, and return the samples.

        Parameters that are given hold from now on; other arguments and errors are those of `Model.run`.
        ValueError also: a parameter by which the program is made anew, such as the size of an array.
        """
        names = checked_names(record)
        seconds, instance = checked_timeout(timeout), self._instance
        checked_function("on_block", on_block)
        with Interrupts(), self._lock:
            watch(instance.session.control)
            settings = self._starts.numbers(set or {}, parameters, instance)
            self._starts.refuse_unknown(parameters, instance, "run", _RUN_ARGUMENTS)
            given = tuple(settings)
            way = self._ways.get(given)
            if way is None:
                way = self._ways[given] = way_of(given, instance)
            if way.slots is None:
                raise ValueError(f"{', '.join(given)} cannot change on the way: give it to Model.start")
            assignments = list(zip(way.slots, settings.values(), strict=True))
            t1 = None if duration is None else self.t + float(duration)
            start = RunStart(assignments, way.follow, t1=t1)
            try:
                run = one_run(
                    instance, start, names, self._source, timeout=seconds, on_block=on_block, base=self._here,
                    continues=self._begun,
                )  # fmt: skip
            except BaseException:
                self._here.restore(self._prepared.values, self._prepared.simulator)
                raise
            self._here, self._begun = self._prepared.checkpoint(), True
        return run.check() if check else run

    def snapshot(self) -> Snapshot:
        """Return all that it goes on from, to come back to by `restore`."""
        with self._lock:
            return Snapshot(self.t, self, self._begun, self._here)

    def restore(self, snapshot: Snapshot) -> None:
        """Go back to where a snapshot was taken. ValueError: it is another simulation's."""
        if snapshot._of is not self:  # noqa: SLF001 - the class beside it
            raise ValueError("a snapshot can only be restored by the simulation that it was taken of")
        with self._lock:
            self._here, self._begun = snapshot._checkpoint, snapshot._begun  # noqa: SLF001
            self._here.restore(self._prepared.values, self._prepared.simulator)
