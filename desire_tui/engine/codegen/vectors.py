"""Array statements of a pass: loops over strips of elements, neighbours of one length in one loop."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen import products, templates
from desire_tui.engine.codegen.draws import advance
from desire_tui.engine.codegen.elements import (
    ElementExpressions,
    Prepared,
    invariants,
    lane_states,
    needed_draws,
)  # fmt: skip
from desire_tui.engine.codegen.lanes import Lanes
from desire_tui.engine.codegen.learning import write_learning
from desire_tui.engine.codegen.loops import loop
from desire_tui.engine.codegen.reach import Reach, groups, needs_copy, statement_reach, value_reach, walk
from desire_tui.engine.codegen.rolling import Rolled
from desire_tui.engine.codegen.statements import ScalarStatements
from desire_tui.engine.codegen.strips import Strip
from desire_tui.engine.lowered import (
    Deriv,
    DerivVec,
    Learn,
    MatVec,
    Outer,
    RowOf,
    Set,
    SetDot,
    SetMat,
    SetVec,
    Shifted,
    Vec,
)  # fmt: skip
from desire_tui.engine.values import IROW

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from desire_tui.engine.codegen.cells import Cells
    from desire_tui.engine.codegen.text import Text
    from desire_tui.engine.lowered import Action, Value


class Statements(ScalarStatements):
    """All statements. `temps` says how many doubles of scratch the context's `temps` must hold."""

    def __init__(self, text: Text, cells: Cells, width: int) -> None:
        super().__init__(text, cells)
        self.wide = Lanes(text, width)
        self.temps = 0
        self._top = 0

    def write(self, actions: Iterable[Action | Rolled]) -> None:
        """Write statements in order, array statements that allow it in one loop."""
        for group in groups(actions):
            if isinstance(group[0], Rolled):
                self._rolled(group[0])
            elif isinstance(group[0], SetVec | DerivVec):
                self.scalars.forget()
                self._fused([a for a in group if isinstance(a, SetVec | DerivVec)])
            else:
                self.statement(group[0])

    def arrays(self, action: Action) -> None:
        """Write a statement that has its own loops."""
        match action:
            case SetMat():
                self._matrix(action)
            case SetDot():
                self._dot(action)
            case Learn():
                write_learning(self, action)
                self.cells.forget()
            case _:
                super().arrays(action)
        self._top = 0

    def single_element(self, action: Set | Deriv) -> bool:
        """Write a statement over arrays of one element; return False for an ordinary one."""
        if not any(isinstance(n, Vec | Shifted | MatVec | RowOf | Outer) for n in walk(action.value)):
            return False
        if isinstance(action, Set):
            self._fused([SetVec(action.slot, 1, action.value, action.where)])
        else:
            self._fused([DerivVec(action.state, 1, action.value, action.where)])
        return True

    # ------------------------------------------------------------------ memory

    def at(self, slot: int) -> str:
        """Return the address of a slot."""
        return self.text.op(f"getelementptr double, ptr %v, i64 {slot}")

    def temp(self, count: int) -> str:
        """Return scratch memory for an array, free again after the statement."""
        first = self._top
        self._top += -(-count // 8) * 8
        self.temps = max(self.temps, self._top)
        return self.text.op(f"getelementptr double, ptr {self.context.load('temps')}, i64 {first}")

    # ------------------------------------------------------------------ before a loop

    def prepare(self, count: int, per_element: int, *values: Value | None) -> Prepared:
        """Write what one statement's loop needs from before it."""
        prepared = Prepared()
        for value in values:
            if value is None:
                continue
            for part in invariants(value):
                prepared.splats[id(part)] = self.wide.splat(self.scalars.value(part))
            for node in walk(value):
                if isinstance(node, Vec | Shifted | MatVec | RowOf | Outer):
                    prepared.bases[id(node)] = self._base(node)
        if per_element:
            start = self.text.op("load i64, ptr %random")
            prepared.per_element = per_element
            prepared.states = self.text.alloca(self.wide.integers)
            states = lane_states(self.wide, start, count, per_element)
            self.text.do(f"store {self.wide.integers} {states}, ptr {prepared.states}")
            after = advance(self.lanes, start, count * per_element)
            self.text.do(f"store i64 {after}, ptr %random")
        return prepared

    def _base(self, node: Vec | Shifted | MatVec | RowOf | Outer) -> str:
        match node:
            case MatVec():
                return self.product(node)
            case RowOf():
                return self._row(node)
            case Outer():
                return self.at(node.v_slot)
            case _:
                return self.at(node.slot)

    def product(self, node: MatVec) -> str:
        """Write a matrix product into scratch memory."""
        name = "tmatvec" if node.transposed else "matvec"
        self.text.needs.add(
            products.transposed_times_vector() if node.transposed else products.matrix_times_vector()
        )
        result = self.temp(node.cols if node.transposed else node.rows)
        self.text.do(
            f"call void @{name}(ptr {self.at(node.slot)}, ptr {self.at(node.x_slot)}, ptr {result}, "
            f"i64 {node.rows}, i64 {node.cols})"
        )
        return result

    def _row(self, node: RowOf) -> str:
        """Return the address of row ((trnc(iRow) - 1) mod rows); beyond all reason, the first one."""
        op = self.text.op
        number = self.cells.load(IROW)
        sane = self.lanes.compare("olt", self.lanes.intrinsic("fabs", number), self.lanes.const(1e15))
        safe = self.lanes.choose(sane, number, self.lanes.const(1.0))
        whole = op(f"add i64 {op(f'fptosi double {safe} to i64')}, -1")
        rest = op(f"srem i64 {whole}, {node.rows}")
        lifted = op(f"add i64 {rest}, {node.rows}")
        row = op(f"select i1 {op(f'icmp slt i64 {rest}, 0')}, i64 {lifted}, i64 {rest}")
        return op(f"getelementptr double, ptr {self.at(node.slot)}, i64 {op(f'mul i64 {row}, {node.cols}')}")

    # ------------------------------------------------------------------ loops

    def sweep(self, count: int, below: int, above: int, body: Callable[[Strip], None]) -> None:
        """Write a loop over `count` elements; the first `below` and last `above` reach outside operands."""
        text, wide = self.text, self.wide
        low, high = min(below, count), max(count - above, 0)
        if low >= high:
            low = high = count
        whole = low + (high - low) // wide.width * wide.width
        if low:
            loop(text, "0", str(low), 1, lambda i: body(Strip(wide, i, 1, edge=True)))
        if whole > low:
            loop(text, str(low), str(whole), wide.width, lambda i: body(Strip(wide, i, wide.width)))
        if high > whole:
            body(Strip(wide, str(whole), high - whole))
        if count > high:
            loop(text, str(high), str(count), 1, lambda i: body(Strip(wide, i, 1, edge=True)))

    def _fused(self, group: list[SetVec | DerivVec]) -> None:
        count = group[0].count
        writers = [self._writer(action) for action in group]
        shifts = [n.by for a in group for n in walk(a.value) if isinstance(n, Shifted)]
        below = max((-by for by in shifts if by < 0), default=0)
        above = max((by for by in shifts if by > 0), default=0)

        def body(strip: Strip) -> None:
            for writer in writers:
                writer(strip)

        self.sweep(count, below, above, body)
        for action in group:
            if isinstance(action, SetVec):
                self._finish(action)
                self.cells.forget(action.slot, action.count)
        self._top = 0

    def _writer(self, action: SetVec | DerivVec) -> Callable[[Strip], None]:
        """Prepare a statement; return what writes it for a strip."""
        per_element = needed_draws(action.value)
        prepared = self.prepare(action.count, per_element, action.value)
        if isinstance(action, DerivVec):
            target = self.text.op(f"getelementptr double, ptr %dx, i64 {action.state}")
            mask = None
        else:
            self._copy = needs_copy(statement_reach(action)) or action.mode == "largest"
            target = self.temp(action.count) if self._copy else self.at(action.slot)
            self._written = target
            mask = None if action.mask_slot is None else self.at(action.mask_slot)
        own = self.at(action.slot) if isinstance(action, SetVec) and action.mode == "add" else None

        def write(strip: Strip) -> None:
            expressions = ElementExpressions(strip, self.cells, prepared)
            value = expressions.value(action.value)
            expressions.finish()
            lanes = strip.lanes
            if mask is not None:
                masked = lanes.compare("une", strip.fetch(mask), lanes.const(0.0))
                value = lanes.choose(masked, lanes.const(0.0), value)
            if own is not None:
                value = lanes.add(strip.fetch(own), value)
            strip.put(target, value)

        return write

    def _finish(self, action: SetVec) -> None:
        """Move a result that could not be written in place."""
        if not self._copy:
            return
        if action.mode == "largest":
            self.text.needs.add(products.largest())
            target = self.at(action.slot)
            self.text.do(f"call void @largest(ptr {self._written}, ptr {target}, i64 {action.count})")
            return
        self._move(self._written, self.at(action.slot), action.count)

    def _move(self, source: str, target: str, count: int) -> None:
        self.text.needs.add("declare void @llvm.memcpy.p0.p0.i64(ptr, ptr, i64, i1)")
        arguments = f"ptr {target}, ptr {source}, i64 {8 * count}, i1 false"
        self.text.do(f"call void @llvm.memcpy.p0.p0.i64({arguments})")

    # ------------------------------------------------------------------ scalars rolled up

    def _rolled(self, rolled: Rolled) -> None:
        """Write the loop over statements of one shape."""
        first = rolled.first
        places = [self.at(o) if isinstance(o, int) else self._lanes(o) for o in rolled.operands]
        if isinstance(first, Set):
            target = self.at(first.slot)
        else:
            target = self.text.op(f"getelementptr double, ptr %dx, i64 {first.state}")

        def body(strip: Strip) -> None:
            leaves = iter(
                strip.fetch(place) if isinstance(operand, int) else place
                for place, operand in zip(places, rolled.operands, strict=True)
            )
            strip.put(target, templates.write_shape(strip.lanes, first.value, leaves))

        self.sweep(rolled.count, 0, 0, body)
        if isinstance(first, Set):
            self.cells.forget(first.slot, rolled.count)

    def _lanes(self, leaves: tuple[int | float, ...]) -> str:
        """Return operands that come round: one for each lane."""
        wide = self.wide
        values = [self.cells.load(x) if isinstance(x, int) else self.lanes.const(x) for x in leaves]
        if len(set(values)) == 1:
            return wide.splat(values[0])
        result = "poison"
        for lane, value in enumerate(values):
            result = self.text.op(f"insertelement {wide.kind} {result}, double {value}, i64 {lane}")
        return result

    # ------------------------------------------------------------------ matrices and sums

    def _matrix(self, action: SetMat) -> None:
        count = action.rows * action.cols
        values = (action.value, action.lower, action.upper)
        prepared = self.prepare(count, needed_draws(*values), *values)
        reads = value_reach(action.value)
        copies = needs_copy(Reach(reads.same, reads.other, {(action.slot, action.slot + count)}))
        own = self.at(action.slot)
        target = self.temp(count) if copies else own
        mask = None if action.mask_slot is None else self.at(action.mask_slot)

        def body(strip: Strip) -> None:
            expressions = ElementExpressions(strip, self.cells, prepared)
            lanes = strip.lanes
            value = expressions.value(action.value)
            if action.mode == "add":
                value = lanes.add(strip.fetch(own), value)
            if action.lower is not None:
                least = expressions.value(action.lower)
                value = lanes.choose(lanes.compare("olt", value, least), least, value)
            if action.upper is not None:
                most = expressions.value(action.upper)
                value = lanes.choose(lanes.compare("ogt", value, most), most, value)
            expressions.finish()
            if mask is not None:
                free = lanes.compare("une", strip.fetch(mask), lanes.const(0.0))
                value = lanes.choose(free, value, strip.fetch(own))
            strip.put(target, value)

        if any(isinstance(n, Outer) for n in walk(action.value)):
            loop(self.text, "0", str(action.rows), 1, lambda row: self._row_strips(action.cols, row, body))
        else:
            self.sweep(count, 0, 0, body)
        if copies:
            self._move(target, own, count)
        self.cells.forget(action.slot, count)

    def _row_strips(self, cols: int, row: str, body: Callable[[Strip], None]) -> None:
        """Write the loop over one row's strips."""
        text, wide = self.text, self.wide
        start = text.op(f"mul i64 {row}, {cols}")
        whole = cols // wide.width * wide.width

        def strip(column: str, active: int) -> None:
            body(Strip(wide, text.op(f"add i64 {start}, {column}"), active, row=row, column=column))

        if whole:
            loop(text, "0", str(whole), wide.width, lambda column: strip(column, wide.width))
        if cols > whole:
            strip(str(whole), cols - whole)

    def _dot(self, action: SetDot) -> None:
        text, lanes = self.text, self.lanes
        total = lanes.const(0.0)
        for term in action.terms:
            count = term.left.count
            left = self.at(term.left.slot)
            if term.right is None:
                text.needs.add(products.total())
                value = text.op(f"call double @total(ptr {left}, i64 {count})")
            else:
                text.needs.add(products.dot())
                right = self._base(term.right)
                value = text.op(f"call double @dot(ptr {left}, ptr {right}, i64 {count})")
            total = lanes.add(total, value if term.sign == 1.0 else lanes.mul(lanes.const(term.sign), value))
        if action.average and action.terms:
            total = lanes.div(total, lanes.const(float(action.terms[0].left.count)))
        self.cells.store(action.slot, total)
