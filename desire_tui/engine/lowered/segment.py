"""A lowered segment: statements, states, what is sampled and shown, the JACOBIAN lines."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, Literal

from desire_tui.engine.data_classes import dataclass, field
from desire_tui.engine.nodes.record import node

if TYPE_CHECKING:
    from desire_tui.engine.diagnostics import Diagnostic
    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.statements import Action, Terminate, Where
    from desire_tui.engine.source import Source


@node
class StateRange:
    """Consecutive states: `count` states from number `first` on live in `slot … slot+count-1`."""

    name: str
    slot: int
    first: int
    count: int
    where: Where


@node
class SampleColumn:
    """A requested variable: its name as written (`x`, `A[2]`) and its slot."""

    name: str
    slot: int
    where: Where


@node
class MeasuredColumn:
    """A column of a data file: its table of `count` numbers (times, then values) stands at `slot`."""

    name: str
    slot: int
    count: int
    where: Where


@node
class MeasuredPoints:
    """Points that a display shows over the run's curves: one column over another, or over t."""

    y: MeasuredColumn
    x: MeasuredColumn | None = None


@node
class SampleRequest:
    """dispt, dispxy, DISPXY or type, with the variables they sample and the points drawn over these."""

    kind: Literal["dispt", "dispxy", "DISPXY", "type"]
    columns: tuple[SampleColumn, ...]
    channel: int | None = None
    where: Where | None = None
    points: tuple[MeasuredPoints, ...] = ()


@node
class Picture:
    """`SHOW A, ncol`: the array's values are kept at each communication point.

    `by_size`: what the segment's own `SHOW *` or `SHOW` before it says; None: what the script's says.
    """

    name: str
    slot: int
    count: int
    columns: int
    by_size: bool | None = None


@node
class JacobianEntry:
    """J[row, column] = value, states from 0."""

    row: int
    column: int
    value: Value
    where: Where | None = None


@node
class Jacobian:
    """The JACOBIAN segment: `body` computes helper variables, `entries` fill the matrix at `slot`."""

    slot: int
    body: tuple[Action, ...]
    entries: tuple[JacobianEntry, ...]


@node
class Breakpoints:
    """Breakpoints of a table function that the script fills: `count` numbers of the array `name`."""

    name: str
    slot: int
    count: int
    where: Where


@node
class Event:
    """What is executed at moments: where `condition` rises through 0, or at `start`, `start` + `period` … .

    `body` sets numbers; it holds no derivatives and no guards but `if`.
    """

    body: tuple[Action, ...]
    where: Where
    condition: Value | None = None
    period: Value | None = None
    start: Value | None = None


@node
class DelayedValue:
    """What an operation `delayed` looks up: the history of `source`; `tau` is how far back."""

    source: Value
    tau: Value
    where: Where


@dataclass(frozen=True)
class Segment:
    """Everything a back end needs. `requests` holds at most one display request and one `type`.

    `scalars` lists the slots of scalars that the segment sets; `counters` says how many history positions
    it has. `faults` lists the compiler's own tests among `body`, which end the run with an error.
    `levels` are the slots of what its `term` statements must exceed, `constants` the script's numbers (slot,
    value) from which subscripts and the like were computed.
    `row_chosen` is the place of a `P#` whose row the script must choose (iRow above 0). `breakpoints` must
    not fall when a run begins. `events` happen at moments; `delays` are by number. `warnings` are to be shown
    once, before a run or by the check. `may_rearrange`: `fast` allows other orders of operations.
    """

    label: str | None
    source: Source
    body: tuple[Action, ...]
    states: tuple[StateRange, ...]
    requests: tuple[SampleRequest, ...] = ()
    pictures: tuple[Picture, ...] = ()
    stash: tuple[SampleColumn, ...] = ()
    recover: tuple[SampleColumn, ...] = ()
    jacobian: Jacobian | None = None
    counters: int = 0
    scalars: tuple[int, ...] = ()
    faults: tuple[Terminate, ...] = ()
    levels: tuple[int, ...] = ()
    constants: tuple[tuple[int, float], ...] = ()
    row_chosen: Where | None = None
    breakpoints: tuple[Breakpoints, ...] = ()
    events: tuple[Event, ...] = ()
    delays: tuple[DelayedValue, ...] = ()
    warnings: tuple[Diagnostic, ...] = ()
    may_rearrange: bool = False
    names: dict[int, str] = field(default_factory=dict)
    noted: ClassVar[object] = None
    """Of a segment known from an earlier process (`deferred_segment`): what a back end noted of its code."""

    @property
    def columns(self) -> tuple[SampleColumn, ...]:
        """What a row of samples holds behind t: the requests' variables in turn, then the stashed ones."""
        return tuple(column for request in self.requests for column in request.columns) + self.stash

    @cached_property
    def order(self) -> int:
        """Number of states."""
        return sum(r.count for r in self.states)
