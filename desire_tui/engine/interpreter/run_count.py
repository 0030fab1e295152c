"""How many runs are still to come: for `run 3 of 5` while a script makes its runs in loops.

What is known at a `drun`: how often each `for` around it was passed, and how often it will be. Where a run
depends on a condition, a `go to` or the bounds of a loop not reached yet, the number is not known, and none
is shown.
"""

from __future__ import annotations

from functools import cached_property
from math import floor
from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.nodes.assignments import Assign
from desire_tui.engine.nodes.commands import Drun
from desire_tui.engine.nodes.control import CallProcedure, For, GoTo, Procedure
from desire_tui.engine.nodes.expressions import Binary, Name, Number, Unary
from desire_tui.engine.nodes.signs import literal

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.interpreter.code_table import ScriptCode, StatementList
    from desire_tui.engine.nodes.expressions import Expr

_ROUNDING = 1e-9
"""Added to the number of steps, so that `0 to 1 step 0.1` makes eleven passes."""
_ANY = "*"
"""Stands for names that are not looked at closely."""


class _Unknown(Exception):  # noqa: N818 - control flow
    """The number of runs is not known."""


def loop_count(first: float, last: float, step: float) -> int:
    """Return how many passes a `for` makes; none where it is not positive."""
    return floor((last - first) / step + _ROUNDING) + 1


def runs_ahead(frames: Sequence[tuple[ScriptCode, int]]) -> int | None:
    """Return how many runs come after the one being made; None: unknown.

    `frames` names the place of the `drun`, then those of the `call`s that led to it, the innermost first.
    """
    count = _Count(1, 0, frozenset())
    try:
        for code, place in frames:
            count = _Survey(code.text).around(code, place, count)
    except _Unknown:
        return None
    return count.ahead


class _Count(NamedTuple):
    """What a part of a script makes: all its runs, those still ahead, and the names on which that depends."""

    runs: int
    ahead: int
    names: frozenset[str]


class _Survey:
    """Counts the runs in parts of one text."""

    def __init__(self, text: StatementList) -> None:
        self.placed, self.structure = text.placed, text.structure
        self._called: set[str] = set()

    @cached_property
    def jumps(self) -> bool:
        """Whether a `go to` may lead anywhere."""
        return any(isinstance(placed.node, GoTo) for placed in self.placed)

    def around(self, code: ScriptCode, place: int, count: _Count) -> _Count:
        """Return the count of the whole text, whose statement at `place`, just carried out, has `count`."""
        if self.jumps:
            raise _Unknown
        first = last = place
        while (opening := self.structure.inside[first]) >= 0:
            node, closing = self.placed[opening].node, self.structure.partner[opening]
            behind = self.runs(last + 1, closing)
            each = self.runs(opening + 1, first) + count.runs + behind
            left = count.ahead + behind
            if isinstance(node, Procedure):
                if None in self.structure.exits.values():
                    raise _Unknown  # it may be left early
                return _Count(each, left, count.names | {_ANY} if count.names else count.names)
            if (
                not isinstance(node, For)
                or self._is_left(closing)
                or self._change(opening, closing, count.names)
            ):
                raise _Unknown
            done, passes = (int(number) for number in code.loops[opening][:2])
            names = count.names.union(*(_names(bound) for bound in (node.first, node.last, node.by)))
            count = _Count(each * passes, left + each * (passes - 1 - done), names)
            first, last = opening, closing
        return count._replace(ahead=count.ahead + self.runs(last + 1, code.last))

    def _is_left(self, closing: int) -> bool:
        """Whether an `exit` may leave a loop before its last pass."""
        return closing in self.structure.exits.values()

    def _change(self, opening: int, closing: int, names: frozenset[str]) -> bool:
        """Whether a loop changes what the number of passes through a loop in it depends on."""
        if _ANY in names:
            return True
        nodes = [self.placed[place].node for place in range(opening, closing)]
        inner = [
            node.variable if isinstance(node, For) else node.target
            for node in nodes
            if isinstance(node, For | Assign)
        ]
        return not names.isdisjoint(target.name for target in inner)

    def runs(self, begin: int, end: int) -> int:
        """Return how many runs the statements `begin … end - 1` make."""
        count, place = 0, begin
        while place < end:
            node, behind = self.placed[place].node, place
            if isinstance(node, Drun):
                count += 1
            elif isinstance(node, CallProcedure):
                count += self._runs_of(node.name)
            elif self.structure.partner.get(place, -1) > place:
                behind = self._closes(place)
                inside = 0 if isinstance(node, Procedure) else self.runs(place + 1, behind)
                count += inside * self._passes(node, behind) if inside else 0
            place = behind + 1
        return count

    def _closes(self, place: int) -> int:
        """Return where a block ends, that of an `if` with its `else`."""
        closing = self.structure.partner[place]
        following = self.structure.partner.get(closing, -1)
        return max(closing, following)

    def _passes(self, node: object, closing: int) -> int:
        if not isinstance(node, For) or self._is_left(closing):
            raise _Unknown
        first, last = _known(node.first), _known(node.last)
        step = _known(node.by) if node.by is not None else 1.0
        return max(loop_count(first, last, step), 0) if step else 0

    def _runs_of(self, name: str) -> int:
        procedure = self.structure.procedures.get(name)
        if procedure is None or name in self._called:
            raise _Unknown
        self._called.add(name)
        try:
            return self.runs(procedure.opens + 1, procedure.closes)
        finally:
            self._called.remove(name)


def _names(bound: Expr | None) -> frozenset[str]:
    """Return the names that a loop's bound depends on."""
    match bound:
        case None | Number():
            return frozenset()
        case Name(name=name):
            return frozenset({name})
        case Unary(operand=operand):
            return _names(operand)
        case Binary(left=left, right=right):
            return _names(left) | _names(right)
    return frozenset({_ANY})


def _known(bound: Expr) -> float:
    value = literal(bound)
    if value is None:
        raise _Unknown
    return value
