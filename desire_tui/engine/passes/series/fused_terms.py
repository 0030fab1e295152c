"""Products with constants joined with the sums that they are terms of: a + c·b as one node."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from desire_tui.engine.lowered.expressions import Const, Op
from desire_tui.engine.lowered.statements import Set
from desire_tui.engine.passes.series.nodes import Constant, Series

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.lowered.statements import Action, Where
    from desire_tui.engine.passes.series.nodes import Operand, SeriesProgram


def join_terms(
    program: SeriesProgram, allocate: Callable[[int], int], where: Where
) -> tuple[tuple[Series, ...], tuple[Action, ...]]:
    """Make `plus_times` of numbers' sums; return the nodes that are left, and what computes new constants.

    Nodes keep what they are at a step's start, and so does whoever reads them.
    """
    joining = _Joining(program, allocate, where)
    gone = {id(term) for node in program.nodes for term in joining.join(node)}
    return tuple(node for node in program.nodes if id(node) not in gone), tuple(joining.actions)


class _Joining:
    def __init__(self, program: SeriesProgram, allocate: Callable[[int], int], where: Where) -> None:
        self._allocate, self._where = allocate, where
        self._negative: dict[int, Constant] = {}
        self.actions: list[Action] = []
        uses = [operand for node in program.nodes for operand in node.operands]
        uses += [piece.derivative for piece in program.states]
        uses += [operand for operand, _ in program.arguments]
        self._uses = Counter(map(id, uses))

    def join(self, node: Series) -> list[Series]:
        """Join a node with a term; return the terms that are gone."""
        if node.kind == "neg" and self._is_term(node.operands[0]):
            term, factor = _parts(node.operands[0])
            gone = node.operands[0]
            node.kind, node.operands = "times", (term, self._negated(factor))
        elif node.kind in {"add", "sub"} and self._is_term(node.operands[1]):
            rest, gone = node.operands
            term, factor = _parts(gone)
            node.operands = rest, term, factor if node.kind == "add" else self._negated(factor)
            node.kind = "plus_times"
        elif node.kind == "add" and self._is_term(node.operands[0]):
            gone, rest = node.operands
            node.kind, node.operands = "plus_times", (rest, *_parts(gone))
        else:
            return []
        assert isinstance(gone, Series)
        return [gone]

    def _is_term(self, operand: Operand) -> bool:
        if not isinstance(operand, Series) or operand.kind != "times" or self._uses[id(operand)] != 1:
            return False
        return operand.count is None and all(o.count is None for o in operand.operands)

    def _negated(self, constant: Constant) -> Constant:
        known = self._negative.get(id(constant))
        if known is None:
            if isinstance(constant.value, Const):
                known = Constant(Const(-constant.value.value), constant.slot, None)
            else:
                slot = self._allocate(1)
                value = Op("neg", (constant.value,))
                self.actions.append(Set(slot, value, self._where))
                known = Constant(value, slot, None)
            self._negative[id(constant)] = known
        return known


def _parts(term: Operand) -> tuple[Series, Constant]:
    """Return a product's series and its constant."""
    assert isinstance(term, Series)
    (series,) = (o for o in term.operands if isinstance(o, Series))
    (constant,) = (o for o in term.operands if isinstance(o, Constant))
    return series, constant
