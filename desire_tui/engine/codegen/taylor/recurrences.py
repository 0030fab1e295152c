"""The function that computes a step's Taylor coefficients: a loop over the order."""

from __future__ import annotations

from hashlib import blake2b
from typing import TYPE_CHECKING

from desire_tui.engine.cancellation import cancellation_point
from desire_tui.engine.codegen.ir.text import IrText, literal
from desire_tui.engine.codegen.jit.compiler import machine
from desire_tui.engine.codegen.jit.piece import Piece
from desire_tui.engine.codegen.taylor.arrays import scattered
from desire_tui.engine.codegen.taylor.frame import Frame
from desire_tui.engine.codegen.taylor.scalar import ScalarRecurrences
from desire_tui.engine.codegen.taylor.sums import Sums
from desire_tui.engine.codegen.taylor.vector import VectorRecurrences
from desire_tui.engine.passes.series.nodes import Constant, Series

if TYPE_CHECKING:
    from desire_tui.engine.codegen.taylor.layout import Layout
    from desire_tui.engine.passes.series.nodes import SeriesProgram

REGISTERS_MOST = 24
"""With more sums of products what turns hand on is kept in memory."""
_OF_ARRAYS = frozenset(("element", "total"))


def recurrences(program: SeriesProgram, layout: Layout) -> Piece:
    """Write `void f(double *values, double *coefficients, int64 order)` for a program.

    Coefficients 0 are taken from the values (`SeriesProgram.values_pass` has put them there). `layout` is
    finished here.
    """
    return _Function(program, layout).piece()


class _Function:
    def __init__(self, program: SeriesProgram, layout: Layout) -> None:
        self._program = program
        self._text = text = IrText()
        self._frame = frame = Frame(text, layout)
        numbers = [node for node in program.nodes if node.count is None]
        many = sum(node.kind in {"mul", "div", "sqrt", "integral", "quotient"} for node in numbers)
        self._sums = Sums(frame, in_memory=many > REGISTERS_MOST)
        self._scalar = ScalarRecurrences(frame, self._sums)
        self._has_sums = [self._scalar.announce(node) for node in numbers].count(True) > 0
        self._sums.finish_layout()
        self._vector = VectorRecurrences(frame, machine().width)
        self._kept = _kept(program)
        self._derivatives = {piece.series.number: piece.derivative for piece in program.states}

    def piece(self) -> Piece:
        """Write everything."""
        text = self._text
        self._begin()
        cells = self._derivative_cells()
        text.jump("begun")
        text.begin("begun")
        text.jump("orders")
        text.begin("orders")
        text.do("%k = phi i64 [ 1, %begun ], [ %k.next, %turn ]")
        text.do("%kf = sitofp i64 %k to double")
        text.do(f"%ki = fdiv double {literal(1.0)}, %kf")
        self._states(cells)
        text.branch(text.op("icmp slt i64 %k, %p"), "inner", "last")
        text.begin("inner")
        self._turn(cells)
        text.jump("turn")
        text.begin("turn")
        text.do("%k.next = add i64 %k, 1")
        text.jump("orders")
        text.begin("last")
        text.do("ret void")
        body = text.body()
        digest = "t" + blake2b(body.encode(), digest_size=10).hexdigest()
        function = f"define void @{digest}(ptr %v, ptr %c, i64 %p) #0 {{\n{body}\n}}"
        return Piece(digest, function, frozenset(text.declarations))

    def _begin(self) -> None:
        """Write what comes before the loop."""
        text, frame = self._text, self._frame
        if frame.layout.cleared:
            text.declarations.add("declare void @llvm.memset.p0.i64(ptr, i8, i64, i1)")
            size = 8 * frame.layout.cleared
            text.do(f"call void @llvm.memset.p0.i64(ptr %c, i8 0, i64 {size}, i1 false)")
        self._sums.begin()
        for node in self._program.nodes:
            if node.count is not None:
                self._vector.load_first(node)
            else:
                frame.load_first(node)
                if node.number in self._kept:
                    frame.put(frame.layout.place(node), frame.first(node))
        for node in self._program.nodes:
            for operand in node.operands:
                if isinstance(operand, Constant):
                    frame.load_constant(operand)
            if node.count is None:
                self._scalar.prepare(node)
        for derivative in self._derivatives.values():
            if isinstance(derivative, Constant):
                frame.load_constant(derivative)

    def _derivative_cells(self) -> dict[int, str]:
        """Make cells for numbers' derivatives, which are one order behind."""
        cells: dict[int, str] = {}
        for piece in self._program.states:
            if piece.series.count is None:
                cell = cells[piece.series.number] = self._text.alloca("double")
                self._text.do(f"store double {self._frame.first(piece.derivative)}, ptr {cell}")
        return cells

    def _states(self, cells: dict[int, str]) -> None:
        """Write what computes the states' coefficients."""
        text, frame = self._text, self._frame
        for piece in self._program.states:
            node = piece.series
            if node.count is not None:
                self._vector.state(node, piece.derivative)
                continue
            slope = text.op(f"load double, ptr {cells[node.number]}")
            frame.now[node.number] = text.op(f"fmul double {slope}, %ki")
            frame.put(frame.layout.place(node), frame.now[node.number], "%k")

    def _turn(self, cells: dict[int, str]) -> None:
        """Write what computes all others' coefficients, and hands on what the next turn needs."""
        text, frame = self._text, self._frame
        if self._has_sums:
            self._sums.turn()
        for node in self._program.nodes:
            cancellation_point()
            if node.kind == "state":
                continue
            if node.count is not None:
                self._vector.write(node)
                continue
            if node.kind in _OF_ARRAYS:
                frame.now[node.number] = self._vector.number(node)
            else:
                self._scalar.write(node)
            if node.number in self._kept:
                frame.put(frame.layout.place(node), frame.now[node.number], "%k")
        if self._has_sums:
            self._sums.end_turn(self._scalar.factors(self._sums.factors))
        for number, cell in cells.items():
            text.do(f"store double {frame.coefficient(self._derivatives[number])}, ptr {cell}")


def _kept(program: SeriesProgram) -> set[int]:
    """Return the numbers whose coefficients others read: the solver, arrays' sums of products."""
    found = {piece.series.number for piece in program.states}
    found |= {operand.number for operand, _ in program.arguments if isinstance(operand, Series)}
    found |= {node.number for node in program.nodes if node.kind == "sqrt"}
    for node in program.nodes:
        reads = {"mul", "div", "sqrt", "integral", "quotient"}
        if node.count is not None and (node.kind in reads or (node.kind == "gather" and scattered(node))):
            found |= {operand.number for operand in node.operands if isinstance(operand, Series)}
    return found
