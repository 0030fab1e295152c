"""The function that computes a step's Taylor coefficients: a loop over the order."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.cancellation import cancellation_point
from desire_tui.engine.codegen.ir.text import IrText
from desire_tui.engine.codegen.jit.compiler import machine
from desire_tui.engine.codegen.jit.piece import Piece
from desire_tui.engine.codegen.taylor.arrays import scattered
from desire_tui.engine.codegen.taylor.frame import Frame
from desire_tui.engine.codegen.taylor.scalar import WITH_SUMS, ScalarRecurrences
from desire_tui.engine.codegen.taylor.short_arrays import ShortArrays
from desire_tui.engine.codegen.taylor.sums import Sums
from desire_tui.engine.codegen.taylor.tile_layout import elements_in_tiles
from desire_tui.engine.codegen.taylor.tiles import Tile
from desire_tui.engine.codegen.taylor.vector import VectorRecurrences
from desire_tui.engine.data_classes import replace
from desire_tui.engine.digest import blake2b
from desire_tui.engine.passes.dead_code import needed_for
from desire_tui.engine.passes.series.nodes import Constant, Series

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from desire_tui.engine.codegen.taylor.layout import Layout
    from desire_tui.engine.codegen.taylor.straight_sums import StraightSums
    from desire_tui.engine.lowered.statements import Action
    from desire_tui.engine.passes.series.nodes import SeriesProgram

REGISTERS_MOST = 24
"""With more sums of products what turns hand on is kept in memory."""
_OF_ARRAYS = frozenset(("element", "total"))


class Written(NamedTuple):
    """A function, and which part of `SeriesProgram.values_pass` must have run before it."""

    piece: Piece
    values_pass: tuple[Action, ...]


def recurrences(program: SeriesProgram, layout: Layout) -> Written:
    """Write `void f(double *values, double *coefficients, int64 order)` for a program.

    Coefficients 0 are taken from the values where they are not computed here. `layout` is finished here.
    """
    if count := elements_in_tiles(program):
        return _in_tiles(program, layout, count)
    frame = Frame(IrText(), layout)
    vector = ShortArrays(frame, program) if layout.is_short else VectorRecurrences(frame, machine().width)
    piece = _looped(program, frame, vector).piece()
    return Written(piece, needed_for(program.values_pass, frame.loaded))


def _in_tiles(program: SeriesProgram, layout: Layout, count: int) -> Written:
    """Write numbers' recurrences, and behind them those of arrays, tile by tile."""
    layout.in_tiles = True
    frame, tile = Frame(IrText(), layout), Tile(program, layout)
    numbers, arrays = (_part(program, of_arrays=of_arrays) for of_arrays in (False, True))
    function = _looped(numbers, frame, VectorRecurrences(frame, machine().width), tile.numbers)
    tile.begin(count)
    _looped(arrays, tile.frame, tile).write()
    tile.finish()
    piece = function.piece(tile.share)
    return Written(piece, needed_for(program.values_pass, frame.loaded + tile.frame.loaded))


def _part(program: SeriesProgram, *, of_arrays: bool) -> SeriesProgram:
    nodes = tuple(node for node in program.nodes if (node.count is not None) is of_arrays)
    states = tuple(piece for piece in program.states if (piece.series.count is not None) is of_arrays)
    return replace(program, nodes=nodes, states=states)


def _looped(
    program: SeriesProgram, frame: Frame, vector: VectorRecurrences, kept: Iterable[int] = ()
) -> _Loop:
    many = sum(node.kind in WITH_SUMS for node in program.nodes if node.count is None)
    sums = Sums(frame, in_memory=many > REGISTERS_MOST)
    function = _Loop(program, frame, sums, vector, kept)
    sums.finish_layout()
    return function


class Recurrences:
    """The function but for how one order follows another: `orders` writes that."""

    def __init__(
        self,
        program: SeriesProgram,
        frame: Frame,
        sums: Sums | StraightSums,
        vector: VectorRecurrences,
        kept: Iterable[int] = (),
    ) -> None:
        """`kept`: numbers whose coefficients others read, besides those that the program tells."""
        self.program, self.frame, self.text = program, frame, frame.text
        self.scalar = ScalarRecurrences(frame, sums)
        numbers = [node for node in program.nodes if node.count is None]
        self.has_sums = [self.scalar.announce(node) for node in numbers].count(True) > 0
        self.vector = vector
        self._kept = _kept(program) | set(kept)
        self._read = self._kept | _read_first(program)
        self.derivatives = {piece.series.number: piece.derivative for piece in program.states}

    def piece(self, finish: Callable[[IrText], None] | None = None, name: str | None = None) -> Piece:
        """Write everything, at last what `finish` writes; without a name it is the text's digest."""
        self.write()
        if finish is not None:
            finish(self.text)
        self.text.do("ret void")
        body = self.text.body()
        name = name or "t" + blake2b(body.encode(), digest_size=10).hexdigest()
        function = f"define void @{name}(ptr %v, ptr %c, i64 %p) #0 {{\n{body}\n}}"
        return Piece(name, function, frozenset(self.text.declarations))

    def write(self) -> None:
        """Write everything but the function's end."""
        self._begin()
        self.orders()

    def orders(self) -> None:
        """Write all orders from 1 on, up to a block where they are there."""
        raise NotImplementedError

    def prepare(self) -> None:
        """Write what stands before the coefficients 0 are read."""

    def _begin(self) -> None:
        """Write what comes before the orders."""
        self.prepare()
        frame = self.frame
        constants = [o for node in self.program.nodes for o in node.operands if isinstance(o, Constant)]
        constants += [d for d in self.derivatives.values() if isinstance(d, Constant)]
        for constant in constants:
            frame.load_constant(constant)
            self.vector.load_constant(constant)
        for node in self.program.nodes:
            if node.count is not None:
                self.vector.load_first(node)
            else:
                self._load_first(node)
        for node in self.program.nodes:
            if node.count is None:
                self.scalar.prepare(node)
            else:
                self.vector.prepare(node)
        self.vector.before_orders()

    def _load_first(self, node: Series) -> None:
        """Read coefficient 0 of a number's series, if anything is made of it."""
        if node.number not in self._read:
            return
        if node.kind == "element" and isinstance(self.vector, ShortArrays):
            self.frame.take_first(node, self.vector.element_first(node))
        else:
            self.frame.load_first(node)
        if node.number in self._kept:
            self.frame.put(self.frame.layout.place(node), self.frame.first(node))

    def states(self, slopes: Mapping[int, str]) -> None:
        """Write what computes the states' coefficients; `slopes`: numbers' derivatives, one order lower."""
        frame = self.frame
        for piece in self.program.states:
            node = piece.series
            if node.count is not None:
                self.vector.state(node, piece.derivative)
                continue
            frame.now[node.number] = frame.over_order(slopes[node.number])
            frame.put(frame.layout.place(node), frame.now[node.number], frame.index)

    def others(self) -> None:
        """Write what computes all others' coefficients."""
        frame = self.frame
        for node in self.program.nodes:
            cancellation_point()
            if node.kind == "state":
                continue
            if node.count is not None:
                self.vector.write(node)
                continue
            if node.kind in _OF_ARRAYS:
                frame.now[node.number] = self.vector.number(node)
            else:
                self.scalar.write(node)
            if node.number in self._kept:
                frame.put(frame.layout.place(node), frame.now[node.number], frame.index)


class _Loop(Recurrences):
    def __init__(
        self,
        program: SeriesProgram,
        frame: Frame,
        sums: Sums,
        vector: VectorRecurrences,
        kept: Iterable[int],
    ) -> None:
        super().__init__(program, frame, sums, vector, kept)
        self._sums = sums

    def prepare(self) -> None:
        text, cleared = self.text, self.frame.layout.cleared
        if cleared:
            text.declarations.add("declare void @llvm.memset.p0.i64(ptr, i8, i64, i1)")
            text.do(f"call void @llvm.memset.p0.i64(ptr %c, i8 0, i64 {8 * cleared}, i1 false)")
        self._sums.begin()

    def orders(self) -> None:
        text = self.text
        cells = self._derivative_cells()
        text.jump("begun")
        text.begin("begun")
        text.jump("orders")
        text.begin("orders")
        text.do("%k = phi i64 [ 1, %begun ], [ %k.next, %turn ]")
        self.frame.load_order()
        self.states({number: text.op(f"load double, ptr {cell}") for number, cell in cells.items()})
        text.branch(text.op("icmp slt i64 %k, %p"), "inner", "last")
        text.begin("inner")
        if self.has_sums:
            self._sums.turn()
        self.vector.turn()
        self.others()
        if self.has_sums:
            self._sums.end_turn(self.scalar.factors(self._sums.factors))
        self.vector.end_turn()
        for number, cell in cells.items():
            text.do(f"store double {self.frame.coefficient(self.derivatives[number])}, ptr {cell}")
        text.jump("turn")
        text.begin("turn")
        text.do("%k.next = add i64 %k, 1")
        text.jump("orders")
        text.begin("last")

    def _derivative_cells(self) -> dict[int, str]:
        """Make cells for numbers' derivatives, which are one order behind."""
        cells: dict[int, str] = {}
        for piece in self.program.states:
            if piece.series.count is None:
                cell = cells[piece.series.number] = self.text.alloca("double")
                self.text.do(f"store double {self.frame.first(piece.derivative)}, ptr {cell}")
        return cells


def _kept(program: SeriesProgram) -> set[int]:
    """Return the numbers whose coefficients others read: the solver, arrays' sums of products."""
    found = {piece.series.number for piece in program.states}
    found |= {operand.number for operand, _ in program.arguments if isinstance(operand, Series)}
    found |= {node.number for node in program.nodes if node.kind == "sqrt"}
    for node in program.nodes:
        if node.count is not None and (node.kind in WITH_SUMS or (node.kind == "gather" and scattered(node))):
            found |= {operand.number for operand in node.operands if isinstance(operand, Series)}
    return found


def _read_first(program: SeriesProgram) -> set[int]:
    """Return the numbers whose coefficient 0 is read by recurrences, arrays, or states of higher order."""
    found = {p.derivative.number for p in program.states if isinstance(p.derivative, Series)}
    for node in program.nodes:
        if node.count is None and node.kind not in WITH_SUMS:
            continue
        found.add(node.number)
        found |= {operand.number for operand in node.operands if isinstance(operand, Series)}
    return found
