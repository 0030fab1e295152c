"""Numbers' series that are made alike, put together as arrays: the forces between all pairs of stars at once.

Nodes of one kind at one depth become the elements of one array. Its recurrence computes several of them at a
time, by a text that does not grow with their number. What they read is gathered, what reads them takes
elements; where neighbours keep their order, neither is needed.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import replace
from desire_tui.engine.lowered.expressions import Vec
from desire_tui.engine.lowered.statements import Set
from desire_tui.engine.passes.series.fused_terms import join_terms
from desire_tui.engine.passes.series.nodes import Constant, Series, SeriesProgram, StatePiece

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    from desire_tui.engine.lowered.statements import Action, Where
    from desire_tui.engine.passes.series.nodes import Operand

_PRODUCTS = frozenset(("mul", "div", "sqrt", "integral", "quotient", "power"))
_OTHERS = frozenset(("add", "sub", "neg", "times", "over", "raised", "plus_times"))
_LEAST = 8
"""Fewer nodes gain nothing."""
_ALWAYS = 64
"""So many nodes are put together in any case: the text would grow with them."""
_LEAST_STATES = 16
"""So many states one behind the other are an array too."""
_WIDTH = 8
"""Elements that are computed at a time, for an estimate."""
_PACKING = 1.5
"""What it costs to put a number into an array, in units of an addition."""


def grouped(program: SeriesProgram, allocate: Callable[[int], int], where: Where) -> SeriesProgram:
    """Return the program with nodes that are alike put together; `allocate` as in `translation`."""
    runs = [run for run in _state_runs(program) if len(run) >= _LEAST_STATES]
    if not runs and not _product_groups(_alike(program.nodes)):
        return program
    nodes, actions = join_terms(program, allocate, where)
    joined = replace(program, nodes=nodes, values_pass=program.values_pass + actions)
    states = [[piece.series for piece in run] for run in runs]
    return _Grouping(joined, _depths(nodes), _worth(joined, states), allocate, where).made()


Groups = dict[tuple[object, ...], list[Series]]


def _alike(nodes: Sequence[Series]) -> Groups:
    depths = _depths(nodes)
    groups: Groups = {}
    for node in nodes:
        if node.count is None and node.kind in _PRODUCTS | _OTHERS:
            groups.setdefault(_key(node, depths[node.number]), []).append(node)
    return groups


def _product_groups(groups: Groups) -> list[list[Series]]:
    return [g for g in groups.values() if len(g) >= _LEAST and g[0].kind in _PRODUCTS]


def _worth(program: SeriesProgram, states: list[list[Series]]) -> list[list[Series]]:
    """Return the groups that gain by it: of products all, of others where little has to be gathered."""
    groups = _alike(program.nodes)
    chosen = states + _product_groups(groups)
    others = [g for g in groups.values() if len(g) >= _LEAST and g[0].kind in _OTHERS]
    wide = {id(node) for group in chosen + others for node in group}
    packed = {id(o) for node in program.nodes if id(node) in wide for o in node.operands}
    packed |= {id(p.derivative) for p in program.states if id(p.series) in wide}
    lanes = {id(node): (id(g), lane) for g in chosen for lane, node in enumerate(g)}
    depths = _depths(program.nodes)
    for group in sorted(others, key=lambda g: depths[g[0].number]):
        columns = zip(*(node.operands for node in group), strict=True)
        together = len(group) / _WIDTH + sum(_gathering(list(column), lanes) for column in columns)
        alone = len(group) + _PACKING * sum(id(node) in packed for node in group)
        if together <= alone or len(group) >= _ALWAYS:
            chosen.append(group)
            lanes |= {id(node): (id(group), lane) for lane, node in enumerate(group)}
    return chosen


def _gathering(operands: list[Operand], lanes: dict[int, tuple[int, int]]) -> float:
    """Estimate what it costs to gather what a group reads."""
    if all(operand is operands[0] for operand in operands) or isinstance(operands[0], Constant):
        return 0.0
    cost = 0.0
    for first in range(0, len(operands), _WIDTH):
        found = [lanes.get(id(operand)) for operand in operands[first : first + _WIDTH]]
        sources = {(lane[0], lane[1] // _WIDTH) for lane in found if lane is not None}
        in_order = all(lane is not None and lane[1] == first + i for i, lane in enumerate(found))
        cost += 0.0 if in_order and len(sources) == 1 else max(len(sources) - 1, 1)
        cost += _PACKING * found.count(None)
    return cost


def _depths(nodes: Iterable[Series]) -> dict[int, int]:
    """Return how far each node is from what is given; an integral's factor comes later than the integral."""
    depths: dict[int, int] = {}
    for node in nodes:
        before = node.operands[1:] if node.kind == "integral" else node.operands
        below = [depths[o.number] for o in before if isinstance(o, Series)]
        depths[node.number] = 1 + max(below, default=-1)
    return depths


def _state_runs(program: SeriesProgram) -> list[list[StatePiece]]:
    """Return the states that are numbers, together those that are neighbours among all and in memory."""
    runs: list[list[StatePiece]] = []
    for piece in program.states:
        if piece.series.count is not None:
            continue
        last = runs[-1][-1] if runs else None
        if last and (piece.first, piece.series.slot) == (last.first + 1, last.series.slot + 1):
            runs[-1].append(piece)
        else:
            runs.append([piece])
    return runs


def _key(node: Series, depth: int) -> tuple[object, ...]:
    """Return what nodes of one group have in common."""
    moves = tuple(isinstance(operand, Series) for operand in node.operands)
    square = len(node.operands) == 2 and node.operands[0] is node.operands[1]
    itself = node in node.operands
    wide = any(o.count is not None for o in node.operands)
    return node.kind, depth, moves, square, itself, wide


class _Grouping:
    def __init__(
        self,
        program: SeriesProgram,
        depths: dict[int, int],
        groups: list[list[Series]],
        allocate: Callable[[int], int],
        where: Where,
    ) -> None:
        self._program, self._depths, self._allocate, self._where = program, depths, allocate, where
        self._nodes: list[Series] = []
        self._copies: list[Action] = []
        self._new: dict[int, Series] = {}
        self._groups = groups
        self._arrays: dict[int, Series] = {}
        self._elements: dict[tuple[int, int], Series] = {}
        self._gathered: dict[tuple[int, ...], Operand] = {}
        self._place = {
            node.number: (group, lane)
            for group, members in enumerate(groups)
            for lane, node in enumerate(members)
        }
        """Of a member: its group's number, its element's."""

    def made(self) -> SeriesProgram:
        """Return the new program."""
        integrals: list[tuple[Series, list[Series]]] = []
        for node in sorted(self._program.nodes, key=lambda n: self._depths[n.number]):
            place = self._place.get(node.number)
            members = [node] if place is None else self._groups[place[0]]
            if place is not None and place[0] in self._arrays:
                continue
            made = self._node(members)
            if place is None:
                self._new[node.number] = made
            else:
                self._arrays[place[0]] = made
            if node.kind == "integral":
                integrals.append((made, members))
        for made, members in integrals:
            made.operands = (self._operand(members, 0), *made.operands)
        states = tuple(self._states())
        arguments = tuple(self._lane(operand, at) for operand, at in self._program.arguments)
        for number, node in enumerate(self._nodes):
            node.number = number
        actions = self._program.values_pass + tuple(self._copies)
        program = self._program
        return SeriesProgram(
            actions, tuple(self._nodes), states, arguments, program.mode_count, program.conditions
        )

    def _states(self) -> Iterator[StatePiece]:
        """Yield the states' pieces, neighbours as one."""
        derivatives = {p.series.number: p.derivative for p in self._program.states}
        for piece in self._program.states:
            place = self._place.get(piece.series.number)
            if place is None:
                derivative = self._mapped(piece.derivative)
                yield StatePiece(self._new[piece.series.number], piece.first, piece.count, derivative)
            elif place[1] == 0:
                members = self._groups[place[0]]
                found = self._gather([derivatives[member.number] for member in members])
                yield StatePiece(self._arrays[place[0]], piece.first, len(members), found)

    def _node(self, members: list[Series]) -> Series:
        """Make one node of one or several; an integral's factor is still to come."""
        first = members[0]
        positions = range(1 if first.kind == "integral" else 0, len(first.operands))
        operands = tuple(self._operand(members, position) for position in positions)
        lanes = tuple(self._lane(operand, at) for operand, at in first.lanes)
        if len(members) == 1:
            slot, slots, count = first.slot, first.slots, first.count
        else:
            slot, slots = _neighbours([member.slot for member in members])
            count = len(members)
        made = Series(0, first.kind, slot, count, operands, first.by, first.matrix, lanes, slots)
        self._nodes.append(made)
        return made

    def _operand(self, members: list[Series], position: int) -> Operand:
        """Return what members read: one operand that they share, an array, or elements gathered."""
        given = [member.operands[position] for member in members]
        if all(operand is given[0] for operand in given):
            return self._mapped(given[0])
        key = tuple(map(id, given))
        if key not in self._gathered:
            self._gathered[key] = self._gather(given)
        return self._gathered[key]

    def _gather(self, given: list[Operand]) -> Operand:
        size = len(given)
        constants = [operand for operand in given if isinstance(operand, Constant)]
        if len(constants) == size:
            slot = self._allocate(size)
            self._copies += [Set(slot + i, c.value, self._where) for i, c in enumerate(constants)]
            return Constant(Vec(slot, size), slot, size)
        lanes = tuple(self._lane(operand, 0) for operand in given)
        array = lanes[0][0]
        if array.count == size and all(lane == (array, i) for i, lane in enumerate(lanes)):
            return array
        used = tuple({id(operand): operand for operand, _ in lanes}.values())
        slot, slots = _neighbours([self._slot(operand) for operand in given])
        made = Series(0, "gather", slot, size, used, lanes=lanes, slots=slots)
        self._nodes.append(made)
        return made

    def _slot(self, operand: Operand) -> int:
        """Return where a number stands at a step's start; one that the program's text tells is put there."""
        if operand.slot >= 0:
            return operand.slot
        assert isinstance(operand, Constant)
        slot = self._allocate(1)
        self._copies.append(Set(slot, operand.value, self._where))
        return slot

    def _lane(self, operand: Operand, at: int) -> tuple[Operand, int]:
        """Return where an element is now."""
        if isinstance(operand, Constant):
            return operand, at
        place = self._place.get(operand.number)
        return (self._new[operand.number], at) if place is None else (self._arrays[place[0]], place[1])

    def _mapped(self, operand: Operand) -> Operand:
        """Return what an operand is now."""
        if isinstance(operand, Constant):
            return operand
        place = self._place.get(operand.number)
        if place is None:
            return self._new[operand.number]
        made = self._elements.get(place)
        if made is None:
            array = self._arrays[place[0]]
            made = self._elements[place] = Series(0, "element", operand.slot, None, (array,), by=place[1])
            self._nodes.append(made)
        return made


def _neighbours(slots: Sequence[int]) -> tuple[int, tuple[int, ...]]:
    """Return the first slot, and all of them unless each is the one behind the last."""
    together = all(slot == slots[0] + i for i, slot in enumerate(slots))
    return slots[0], () if together else tuple(slots)
