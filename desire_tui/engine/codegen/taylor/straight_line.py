"""The function that computes a small model's Taylor coefficients without a loop: every product written out.

Coefficients are then in registers or on the stack, and nothing is moved from turn to turn.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir.text import IrText
from desire_tui.engine.codegen.jit.compiler import machine
from desire_tui.engine.codegen.taylor.frame import Frame
from desire_tui.engine.codegen.taylor.recurrences import Recurrences
from desire_tui.engine.codegen.taylor.scalar import WITH_SUMS
from desire_tui.engine.codegen.taylor.straight_sums import StraightSums
from desire_tui.engine.codegen.taylor.vector import VectorRecurrences
from desire_tui.engine.integration.taylor.memory import ORDER_MOST

if TYPE_CHECKING:
    from desire_tui.engine.codegen.jit.piece import Piece
    from desire_tui.engine.codegen.taylor.layout import Layout
    from desire_tui.engine.passes.series.nodes import SeriesProgram

SUMS_MOST = 16
"""Sums of products of a small model: each has 200 products up to order 20."""


def is_small(program: SeriesProgram) -> bool:
    """Whether straight-line code is short enough."""
    sums = sum(node.kind in WITH_SUMS for node in program.nodes)
    return sums <= SUMS_MOST and all(node.count is None for node in program.nodes)


def straight_line(program: SeriesProgram, layout: Layout, name: str) -> Piece:
    """Write what `recurrences` writes, with the same bits, for a small model; `layout` is finished."""
    frame = Frame(IrText(), layout)
    return _StraightLine(program, frame, StraightSums(frame)).piece(name=name)


class _StraightLine(Recurrences):
    def __init__(self, program: SeriesProgram, frame: Frame, sums: StraightSums) -> None:
        super().__init__(program, frame, sums, VectorRecurrences(frame, machine().width))
        self._sums = sums

    def prepare(self) -> None:
        self._sums.begin()

    def orders(self) -> None:
        text, frame = self.text, self.frame
        slopes = {number: frame.first(derivative) for number, derivative in self.derivatives.items()}
        for order in range(1, ORDER_MOST + 1):
            frame.order = order
            self.scalar.begin_turn()
            self.states(slopes)
            if order < ORDER_MOST:
                text.branch(text.op(f"icmp eq i64 %p, {order}"), "last", f"order{order}")
                text.begin(f"order{order}")
                self._sums.turn()
                self.others()
                self._sums.end_turn(self.scalar.factors(self._sums.factors))
                slopes = {number: frame.coefficient(d) for number, d in self.derivatives.items()}
        text.jump("last")
        text.begin("last")
