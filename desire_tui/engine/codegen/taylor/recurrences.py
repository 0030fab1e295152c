"""The function that computes a step's Taylor coefficients: a loop over the order."""

from __future__ import annotations

from hashlib import blake2b
from typing import TYPE_CHECKING

from desire_tui.engine.cancellation import cancellation_point
from desire_tui.engine.codegen.ir.text import IrText, literal
from desire_tui.engine.codegen.jit.compiler import machine
from desire_tui.engine.codegen.jit.piece import Piece
from desire_tui.engine.codegen.taylor.frame import Frame
from desire_tui.engine.codegen.taylor.scalar import ScalarRecurrences, helper
from desire_tui.engine.codegen.taylor.vector import VectorRecurrences
from desire_tui.engine.passes.series.nodes import Constant, Series

if TYPE_CHECKING:
    from desire_tui.engine.codegen.taylor.layout import Layout
    from desire_tui.engine.passes.series.nodes import SeriesProgram

_HELPER = "taylor.products"
INLINE_MOST = 40
"""With more sums of products the function that adds to them is called, not written out for each."""
_OF_ARRAYS = frozenset(("element", "total"))


def recurrences(program: SeriesProgram, layout: Layout) -> Piece:
    """Write `void f(double *values, double *coefficients, int64 order)` for a program.

    Coefficients 0 are taken from the values (`SeriesProgram.values_pass` has put them there). `layout` is
    finished here.
    """
    text = IrText()
    frame = Frame(text, layout)
    numbers = [node for node in program.nodes if node.count is None]
    sums = 0
    for node in numbers:
        ScalarRecurrences.reserve(frame, node)
        sums += node.kind in {"mul", "div", "sqrt", "integral", "quotient"}
    wide = _broadcast(program)
    for node in wide:
        layout.row_for("wide", node)
    layout.finish()
    scalar, vector = ScalarRecurrences(frame, _HELPER), VectorRecurrences(frame, machine().width)
    _begin(program, frame, vector, wide)
    cells = _derivative_cells(program, frame)
    text.jump("orders")
    text.begin("orders")
    text.do("%k = phi i64 [ 1, %begun ], [ %k.next, %turn ]")
    text.do("%kf = sitofp i64 %k to double")
    text.do(f"%ki = fdiv double {literal(1.0)}, %kf")
    broadcast = {node.number for node in wide}
    derivatives = {piece.series.number: piece.derivative for piece in program.states}
    for node in program.nodes:
        if node.kind == "state":
            _state(node, derivatives[node.number], frame, vector, cells)
    text.branch(text.op("icmp slt i64 %k, %p"), "inner", "last")
    text.begin("inner")
    for node in program.nodes:
        cancellation_point()
        if node.kind == "state":
            if node.count is None:
                scalar.keep(node)
        elif node.count is not None:
            vector.write(node)
        elif node.kind in _OF_ARRAYS:
            frame.now[node.number] = vector.number(node)
            scalar.keep(node)
        else:
            scalar.write(node)
        if node.number in broadcast:
            frame.put(layout.row_for("wide", node), frame.now[node.number], "%k")
    scalar.end_turn()
    for number, cell in cells.items():
        derivative = derivatives[number]
        text.do(f"store double {frame.coefficient(derivative)}, ptr {cell}")
    text.jump("turn")
    text.begin("turn")
    text.do("%k.next = add i64 %k, 1")
    text.jump("orders")
    text.begin("last")
    for node in program.nodes:
        if node.kind == "state" and node.count is None:
            frame.put(layout.place(node), frame.now[node.number], "%k")
    text.do("ret void")
    body = text.body()
    inline = sums <= INLINE_MOST
    digest = "t" + blake2b(f"{inline}{body}".encode(), digest_size=10).hexdigest()
    name = f"{_HELPER}.{digest}"
    function = f"define void @{digest}(ptr %v, ptr %c, i64 %p) #0 {{\n{body}\n}}".replace(
        f"@{_HELPER}(", f"@{name}("
    )
    return Piece(digest, helper(name, inline=inline) + "\n" + function, frozenset(text.declarations))


def _broadcast(program: SeriesProgram) -> list[Series]:
    """Return the numbers whose coefficients arrays' sums of products read."""
    found: dict[int, Series] = {}
    for node in program.nodes:
        if node.count is None or node.kind not in {"mul", "div", "sqrt", "integral", "quotient"}:
            continue
        for operand in node.operands:
            if isinstance(operand, Series) and operand.count is None:
                found[operand.number] = operand
    return list(found.values())


def _begin(program: SeriesProgram, frame: Frame, vector: VectorRecurrences, wide: list[Series]) -> None:
    """Write what comes before the loop."""
    text, layout = frame.text, frame.layout
    text.declarations.add("declare void @llvm.memset.p0.i64(ptr, i8, i64, i1)")
    text.do(f"call void @llvm.memset.p0.i64(ptr %c, i8 0, i64 {8 * layout.cleared}, i1 false)")
    for node in program.nodes:
        if node.count is None:
            frame.load_first(node)
        else:
            vector.load_first(node)
    for node in wide:
        frame.put(layout.row_for("wide", node), frame.first(node))
    for node in program.nodes:
        for operand in node.operands:
            if isinstance(operand, Constant):
                frame.load_constant(operand)
        if node.count is None:
            ScalarRecurrences.prepare(frame, node)
    for piece in program.states:
        if isinstance(piece.derivative, Constant):
            frame.load_constant(piece.derivative)
    text.jump("begun")
    text.begin("begun")


def _derivative_cells(program: SeriesProgram, frame: Frame) -> dict[int, str]:
    """Make cells for numbers' derivatives, which are one order behind."""
    cells: dict[int, str] = {}
    for piece in program.states:
        if piece.series.count is None:
            cell = cells[piece.series.number] = frame.text.alloca("double")
            frame.text.do(f"store double {frame.first(piece.derivative)}, ptr {cell}")
    return cells


def _state(
    node: Series,
    derivative: Series | Constant,
    frame: Frame,
    vector: VectorRecurrences,
    cells: dict[int, str],
) -> None:
    if node.count is not None:
        vector.state(node, derivative)
        return
    slope = frame.text.op(f"load double, ptr {cells[node.number]}")
    frame.now[node.number] = frame.text.op(f"fmul double {slope}, %ki")
