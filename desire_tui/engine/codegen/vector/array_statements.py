"""Array statements of a pass: loops over strips of elements, neighbours of one length in one loop."""

from __future__ import annotations

from typing import TYPE_CHECKING, assert_never

from desire_tui.engine.codegen.ir.shared_loops import is_large
from desire_tui.engine.codegen.scalar.rerolling import Rolled
from desire_tui.engine.codegen.vector.elements import StripExpressions, is_separable
from desire_tui.engine.codegen.vector.fusion import groups, needs_copy, statement_footprint
from desire_tui.engine.codegen.vector.operands import ArrayOperands
from desire_tui.engine.codegen.vector.rerolled_loops import write_rolled
from desire_tui.engine.lowered.effects import count_draws, reads_replaced
from desire_tui.engine.lowered.expressions import ElementOperand, ShiftedVec
from desire_tui.engine.lowered.statements import Deriv, DerivVec, LearningStep, Set, SetDot, SetMat, SetVec
from desire_tui.engine.lowered.walk import walk_values

if TYPE_CHECKING:
    from collections.abc import Iterable

    from desire_tui.engine.codegen.vector.strips import Strip
    from desire_tui.engine.lowered.statements import Action, ArrayAction


class ArrayStatements(ArrayOperands):
    """All statements."""

    def write(self, actions: Iterable[Action | Rolled]) -> None:
        """Write statements in order, array statements that allow it in one loop."""
        for group in groups(actions):
            if isinstance(group[0], Rolled):
                write_rolled(self, group[0])
            elif isinstance(group[0], SetVec | DerivVec) and not reads_replaced(group[0]):
                self.scalars.forget()
                self._fused([a for a in group if isinstance(a, SetVec | DerivVec)])
            else:
                self.statement(group[0])

    def arrays(self, action: ArrayAction) -> None:
        """Write a statement that has its own loops."""
        match action:
            case SetVec() | SetMat() if reads_replaced(action):
                from desire_tui.engine.codegen.vector.in_place import write_in_place

                write_in_place(self, action)
            case SetMat():
                from desire_tui.engine.codegen.vector.matrices import write_matrix

                write_matrix(self, action)
            case SetDot():
                from desire_tui.engine.codegen.vector.matrices import write_dot

                write_dot(self, action)
            case LearningStep():
                from desire_tui.engine.codegen.vector.learning import write_learning  # few programs learn

                write_learning(self, action)
                self.cells.forget()
            case SetVec() | DerivVec():
                self._fused([action])
            case _:
                assert_never(action)
        self.free_temps()

    def single_element(self, action: Set | Deriv) -> bool:
        """Write a statement over arrays of one element; return False for an ordinary one."""
        if not any(isinstance(n, ElementOperand) for n in walk_values(action.value)):
            return False
        if isinstance(action, Set):
            self._fused([SetVec(action.slot, 1, action.value, action.where)])
        else:
            self._fused([DerivVec(action.state, 1, action.value, action.where)])
        return True

    # ------------------------------------------------------------------ elementwise loops

    def _fused(self, group: list[SetVec | DerivVec]) -> None:
        """Write statements of one length as one loop, which threads share if it is long."""
        count = group[0].count
        is_shared = is_large(count * len(group)) and is_separable(*(action.value for action in group))
        block = self.block() if is_shared else self
        writers = [_Writer(self, action) for action in group]
        if is_shared:
            _sweep(block, group, [_Writer(block, action) for action in group])
            self.share(block, count)
        else:
            _sweep(self, group, writers)
        for writer in writers:
            writer.finish()
        self.free_temps()


def _sweep(statements: ArrayOperands, group: list[SetVec | DerivVec], writers: list[_Writer]) -> None:
    shifts = [n.by for a in group for n in walk_values(a.value) if isinstance(n, ShiftedVec)]
    below = max((-by for by in shifts if by < 0), default=0)
    above = max((by for by in shifts if by > 0), default=0)

    def body(strip: Strip) -> None:
        for writer in writers:
            writer.write(strip)

    statements.sweep(group[0].count, below, above, body)


class _Writer:
    """Writes one elementwise statement: before the loop, in it, and behind it."""

    def __init__(self, statements: ArrayStatements, action: SetVec | DerivVec) -> None:
        self._statements = statements
        self._action = action
        self._mask = self._own = ""
        self._copy = False
        self._prepared = statements.prepare(action.count, count_draws(action.value), action.value)
        if isinstance(action, DerivVec):
            self._target = statements.text.op(f"getelementptr double, ptr %dx, i64 {action.state}")
            return
        self._copy = needs_copy(statement_footprint(action)) or action.mode == "largest"
        self._target = statements.temp(action.count) if self._copy else statements.at(action.slot)
        if action.mask_slot is not None:
            self._mask = statements.at(action.mask_slot)
        if action.mode == "add":
            self._own = statements.at(action.slot)

    def write(self, strip: Strip) -> None:
        """Write the statement for one strip."""
        expressions = StripExpressions(strip, self._statements.cells, self._prepared)
        value = expressions.value(self._action.value)
        expressions.finish()
        lanes = strip.lanes
        if self._mask:
            masked = lanes.compare("une", strip.fetch(self._mask), lanes.const(0.0))
            value = lanes.choose(masked, lanes.const(0.0), value)
        if self._own:
            value = lanes.add(strip.fetch(self._own), value)
        strip.put(self._target, value)

    def finish(self) -> None:
        """Move a result that could not be written in place."""
        statements, action = self._statements, self._action
        if not isinstance(action, SetVec):
            return
        match action.mode:
            case "largest":
                from desire_tui.engine.codegen.vector import products

                statements.text.declarations.add(products.largest())
                target = statements.at(action.slot)
                arguments = f"ptr {self._target}, ptr {target}, i64 {action.count}"
                statements.text.do(f"call void @largest({arguments})")
            case "set" | "add":
                if self._copy:
                    statements.move(self._target, statements.at(action.slot), action.count)
            case _:
                assert_never(action.mode)
        statements.cells.forget(action.slot, action.count)
