"""Collects a segment's actions while its statements are lowered: guards, counters, requests."""

from __future__ import annotations

from math import prod
from typing import TYPE_CHECKING, Literal

from desire_tui.engine.data_classes import dataclass, field
from desire_tui.engine.lowered.expressions import Const, Load, Op, Vec
from desire_tui.engine.lowered.segment import Event
from desire_tui.engine.lowered.statements import Deriv, DerivVec, Guard, Set, SetVec, Terminate
from desire_tui.engine.values import IROW

if TYPE_CHECKING:
    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.segment import Picture, SampleColumn, SampleRequest
    from desire_tui.engine.lowered.statements import Action, Where
    from desire_tui.engine.lowering.lowering_context import LoweringContext
    from desire_tui.engine.lowering.persistence import Branch, Mark
    from desire_tui.engine.lowering.states import StateTable
    from desire_tui.engine.source import Span
    from desire_tui.engine.values import Quantity

GuardKind = Literal["step", "out", "sample", "if", "event"]
Path = tuple[tuple[int, bool], ...]


@dataclass
class OpenGuard:
    """A guard whose end has not been reached; `otherwise` says that its `else` was passed.

    `serial` distinguishes it from other guards; `outer` is the body that it will be a statement of. What has
    surely been set: `saved` at its beginning, `after_then` at the end of the branch `then`. The kind
    `event` is the block of moments: where `condition` rises through 0, or every `period` from `start` on.
    """

    kind: GuardKind
    where: Where
    serial: int
    outer: list[Action]
    saved: Mark
    condition: Value | None = None
    every: int = 1
    period: Value | None = None
    start: Value | None = None
    otherwise: bool = False
    then: tuple[Action, ...] = ()
    after_then: Branch | None = None


@dataclass
class SegmentBuilder:
    """What one segment becomes, piece by piece.

    `body` takes the next statement: the segment's, or that of the innermost of the open `guards`. `counters`,
    `terms` and `serials` number history positions, `term` statements and guards. `once_only` holds the place
    of a display and a type request. By states (slot, count): `derivative_paths` the guards around each of
    their `d/dt` lines, `_held` the numbers that keep a derivative whose guard is shut. `_derivative_arrays`:
    by a whole array's slot and size the stretches of it that have a `d/dt` (slot, count, guards, name).
    `faults`: the compiler's own tests, which end the run with an error. `levels`: slots of
    what each `term` must exceed. `events`: what moments execute. `names`: scalars by slot, for messages.
    """

    context: LoweringContext
    states: StateTable
    rule: int | None
    body: list[Action] = field(default_factory=list)
    guards: list[OpenGuard] = field(default_factory=list)
    counters: int = 0
    terms: int = 0
    serials: int = 0
    requests: list[SampleRequest] = field(default_factory=list)
    pictures: list[Picture] = field(default_factory=list)
    by_size: bool | None = None
    may_rearrange: bool = False
    """Whether the segment says `fast`."""
    stash: list[SampleColumn] = field(default_factory=list)
    recover: list[SampleColumn] = field(default_factory=list)
    once_only: dict[str, Span] = field(default_factory=dict)
    derivative_paths: dict[tuple[int, int], list[Path]] = field(default_factory=dict)
    names: dict[int, str] = field(default_factory=dict)
    levels: list[int] = field(default_factory=list)
    faults: list[Terminate] = field(default_factory=list)
    events: list[Event] = field(default_factory=list)
    _exhausted: list[Terminate] = field(default_factory=list)
    _derivative_arrays: dict[tuple[int, int], list[tuple[int, int, Path, str]]] = field(default_factory=dict)
    _held: dict[tuple[int, int], tuple[int, Where]] = field(default_factory=dict)

    def counter(self) -> int:
        """Return the number of a new history position."""
        self.counters += 1
        return self.counters - 1

    def watch(self, slot: int, where: Where) -> None:
        """End the run with error 232 when this number is 1; that is tested at every step, like a `term`."""
        self._exhausted.append(Terminate(Load(slot), 0, where, fault="no-template-left"))

    def watch_row(self, where: Where) -> None:
        """End the run with error 124 where iRow chooses no row: 1 - swtch(iRow) > 0."""
        chosen = Op("swtch", (Load(IROW),))
        test = Terminate(Op("sub", (Const(1.0), chosen)), 0, where, fault="row-not-chosen")
        self.body.append(test)
        self.faults.append(test)

    # ------------------------------------------------------------------------------------------ guards

    @property
    def path(self) -> Path:
        """The guards around the present line, and which branch of each."""
        return tuple((g.serial, g.otherwise) for g in self.guards)

    def open(self, kind: GuardKind, where: Where, condition: Value | None = None, every: int = 1) -> None:
        """Begin a guard."""
        self.serials += 1
        saved = self.context.flow.mark()
        self.guards.append(OpenGuard(kind, where, self.serials, self.body, saved, condition, every))
        self.body = []

    @property
    def at_moment(self) -> bool:
        """Whether the present line stands in the block of an `event` or `every`."""
        return any(guard.kind == "event" for guard in self.guards)

    def end_moment(self) -> bool:
        """End an open block of `event` or `every`; False if an `if` inside it is not closed."""
        kinds = [guard.kind for guard in self.guards]
        if "event" not in kinds:
            return True
        for _ in kinds[kinds.index("event") :]:
            self._close()
        return kinds[-1] == "event"

    def begin_moment(self, where: Where, condition: Value | None, times: tuple[Value, Value] | None) -> None:
        """Begin the block of an `event` or `every`: OUT, SAMPLE and step code ends here."""
        while self.guards and self.guards[-1].kind != "if":
            self._close()
        self.open("event", where, condition)
        if times is not None:
            self.guards[-1].period, self.guards[-1].start = times

    def otherwise(self) -> bool:
        """Turn the innermost `if` at an `else`; False if there is none open."""
        inner = self._close_down_to_if()
        if inner is None or not self.guards or self.guards[-1].otherwise:
            return False
        guard = self.guards[-1]
        flow = self.context.flow
        guard.then, guard.after_then, guard.otherwise = tuple(self.body), flow.take_back(guard.saved), True
        self.body = []
        self._reopen(inner)
        return True

    def end_if(self) -> bool:
        """Close the innermost `if`; OUT, SAMPLE and step inside it go on behind it."""
        inner = self._close_down_to_if()
        if inner is None:
            return False
        self._close()
        self._reopen(inner)
        return True

    def finish(self) -> tuple[Action, ...]:
        """Close what is open and return the body; derivatives held under guards come last."""
        while self.guards:
            self._close()
        self.body += self._exhausted
        self.faults += self._exhausted
        for term, watched in enumerate(self.faults, self.terms):
            watched.number = term  # type: ignore[misc]  # frozen for the type checker only
        for (slot, count), (held, where) in self._held.items():
            number = self.states.number(slot)
            if number is not None:
                self.body.append(
                    Deriv(number, Load(held), where)
                    if count == 1
                    else DerivVec(number, count, Vec(held, count), where)
                )
        return tuple(self.body)

    def _close_down_to_if(self) -> list[OpenGuard] | None:
        if not any(g.kind == "if" for g in self.guards):
            return None
        inner = []
        while self.guards[-1].kind != "if":
            inner.append(self._close())
        return inner[::-1]

    def _reopen(self, inner: list[OpenGuard]) -> None:
        for guard in inner:
            self.open(guard.kind, guard.where, guard.condition, guard.every)

    def _close(self) -> OpenGuard:
        guard = self.guards.pop()
        flow = self.context.flow
        then, orelse = (guard.then, tuple(self.body)) if guard.otherwise else (tuple(self.body), ())
        if guard.after_then is not None:
            flow.keep_common(guard.saved, guard.after_then)
        else:
            flow.take_back(guard.saved)
        self.body = guard.outer
        if guard.kind == "event":
            self.events.append(Event(then, guard.where, guard.condition, guard.period, guard.start))
        elif then or orelse:
            self.body.append(Guard(guard.kind, then, guard.where, guard.condition, orelse, guard.every))
        return guard

    # ------------------------------------------------------------------------------------------ derivatives

    def derivative(self, slot: int, count: int, value: Value, where: Where, *, array: bool = False) -> None:
        """Add a derivative of `count` states from `slot` on; `array`: a vector's, even if it has one element.

        Under a guard the derivative keeps its last value where the guard is shut, 0 at first: it is computed
        into numbers of the compiler's own, and the derivative proper reads them at the end of the pass.
        """
        number = self.states.number(slot)
        if number is None:
            return
        if not self.guards:
            self.body.append(DerivVec(number, count, value, where) if array else Deriv(number, value, where))
            return
        held = self._held.get((slot, count))
        if held is None:
            held = self._held[slot, count] = (self.context.scope.hidden(count), where)
        made = (
            SetVec(held[0], count, value, where, persistent=True)
            if array
            else Set(held[0], value, where, persistent=True)
        )
        self.body.append(made)

    def is_second_derivative(self, slot: int, count: int) -> bool:
        """Whether this state already has a `d/dt` that could hold in the same pass (error 101)."""
        path = self.path if self.guards else ()
        earlier = self.derivative_paths.get((slot, count))
        if earlier is None:
            self.derivative_paths[slot, count] = [path]
            return False
        second = any(_same_pass(path, other) for other in earlier)
        earlier.append(path)
        return second

    def overlaid(self, slot: int, count: int, array: Quantity) -> str | None:
        """Return the array through which some of these states of `array` have a `d/dt` already (error 101).

        An element may be given a derivative of its own beside its vector's (boundary elements), but not
        beside that of another array that shares only a part of the storage.
        """
        path = self.path if self.guards else ()
        first, size = array.slot, prod(array.shape)
        lines = self._derivative_arrays.setdefault((first, size), [])
        lines.append((slot, count, path, array.name))
        for other, theirs in self._derivative_arrays.items():
            if theirs is lines or other[0] >= first + size or first >= sum(other):
                continue
            for at, length, earlier, name in theirs:
                if at < slot + count and slot < at + length and _same_pass(path, earlier):
                    return name
        return None


def _same_pass(path: Path, earlier: Path) -> bool:
    """Whether some pass reaches two lines: they stand in no two branches of one `if`."""
    branches = dict(path)
    return all(branches.get(serial, branch) == branch for serial, branch in earlier)
