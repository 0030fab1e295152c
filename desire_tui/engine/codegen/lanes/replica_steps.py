"""A whole step of a vector model of replicas, block by block, in registers.

All stages of some replicas are computed before the next ones are read. The numbers are those of passes over
whole vectors: the same operations, the same functions of the vector library.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir.lanes import Lanes
from desire_tui.engine.codegen.ir.shared_loops import BLOCK, is_large, write_shared
from desire_tui.engine.codegen.ir.text import IrText
from desire_tui.engine.codegen.jit.compiler import machine
from desire_tui.engine.codegen.jit.piece import Piece
from desire_tui.engine.codegen.lanes.lane_cells import LaneCells, Number
from desire_tui.engine.codegen.lanes.lane_expressions import LaneExpressions
from desire_tui.engine.codegen.lanes.lane_stages import advance, save
from desire_tui.engine.codegen.lanes.replicas import Replicas
from desire_tui.engine.digest import blake2b
from desire_tui.engine.lowered.statements import Set
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.integration.tableaus import Tableau
    from desire_tui.engine.passes.replicas import ReplicatedModel


def replica_steps(model: ReplicatedModel, tableau: Tableau) -> Piece:
    """Return `void NAME(ptr values, ptr first, double t_base, double k, double dt)`: step k from t_base.

    `first`: derivatives at the step's start, where they were computed before code behind OUT changed what
    they depend on; null: they are computed here. Threads share the replicas where there are many.
    """
    return _ReplicaSteps(model, tableau).piece()


_NUMBERS = ("%t_base", "%k", "%dt")


class _ReplicaSteps:
    def __init__(self, model: ReplicatedModel, tableau: Tableau) -> None:
        self.model, self.tableau, self.text = model, tableau, IrText()
        piece = machine().width
        self.runs = Replicas(self.text, 2 * piece, piece)
        self.one = Lanes(self.text)
        vectors = frozenset((*model.states, *model.read, *model.assigned))
        self.scalars = sorted(model.scalars | {T})
        self.cells = LaneCells(
            self.text, self.runs, {*vectors, *self.scalars}, vectors, model.states, tableau.stages
        )

    def piece(self) -> Piece:
        """Write everything."""
        replicas, width = self.model.replicas, self.runs.width
        work = replicas * len(self.model.statements) * self.tableau.stages
        if not is_large(work):
            self._write("0", str(replicas))
            self.text.do("ret void")
            return _piece(self.text)
        for place, name in enumerate(_NUMBERS):
            at = self.text.op(f"getelementptr double, ptr %c, i64 {place}")
            self.text.do(f"{name} = load double, ptr {at}")
        self._write("%first", "%end")
        from desire_tui.engine.codegen.threads.pool import thread_pool  # few models are so large

        outer = IrText("o")
        outer.alloca(f"[{len(_NUMBERS)} x double]", "%c")
        for place, name in enumerate(_NUMBERS):
            at = outer.op(f"getelementptr double, ptr %c, i64 {place}")
            outer.do(f"store double {name}, ptr {at}")
        block = max(width, BLOCK * replicas // work // width * width)
        write_shared(outer, thread_pool().share, self.text, "%dx", str(replicas), block)
        outer.do("ret void")
        return _piece(outer)

    def _write(self, first: str, end: str) -> None:
        """Write the step of the replicas `first` … `end` - 1; `first` is a multiple of the width."""
        text, width = self.text, self.runs.width
        whole = self.model.replicas // width * width
        text.alloca("i64", "%i")
        for slot in self.scalars:  # before the loop: what is written there may not change them
            text.do(f"%g{slot} = load double, ptr {text.op(f'getelementptr double, ptr %v, i64 {slot}')}")
        text.do(f"store i64 {first}, ptr %i")
        text.jump("next")
        text.begin("next")
        index = text.op("load i64, ptr %i")
        text.do(f"%full = icmp sle i64 {index}, {whole - width}")
        self._move((*self.model.states, *sorted(self.model.read)), index, store=False)
        self._step(index)
        self._move(self.model.states, index, store=True)
        following = text.op(f"add i64 {index}, {width}")
        text.do(f"store i64 {following}, ptr %i")
        text.branch(text.op(f"icmp slt i64 {following}, {end}"), "next", "done")
        text.begin("done")

    def _move(self, vectors: tuple[int, ...], index: str, *, store: bool) -> None:
        """Read a block of vectors, or write it."""
        places = [self._place("%v", index, slot) for slot in vectors]

        def move(mask: str | None) -> None:
            for slot, place in zip(vectors, places, strict=True):
                if store:
                    self._put(place, self.cells.load(slot).name, mask)
                else:
                    self.cells.store(slot, Number(self._get(place, mask), wide=True))

        self._whole_or_part("put" if store else "get", move)

    def _place(self, base: str, index: str, first: int) -> str:
        return self.text.op(
            f"getelementptr double, ptr {base}, i64 {self.text.op(f'add i64 {index}, {first}')}"
        )

    def _whole_or_part(self, what: str, move: Callable[[str | None], None]) -> None:
        """Write what moves a block; the last block may be a part of one, and has a mask."""
        text = self.text
        rest = self.model.replicas % self.runs.width
        labels = [f"{what}.{part}" for part in ("whole", "part", "done")]
        if rest:
            text.branch("%full", labels[0], labels[1])
        else:
            text.jump(labels[0])
        for label, mask in zip(labels, (None, self._mask(rest)), strict=False):
            if mask is not None and not rest:
                continue
            text.begin(label)
            move(mask)
            text.jump(labels[2])
        text.begin(labels[2])

    def _mask(self, rest: int) -> str:
        return "<" + ", ".join(f"i1 {int(lane < rest)}" for lane in range(self.runs.width)) + ">"

    def _get(self, place: str, mask: str | None) -> str:
        runs = self.runs
        if mask is None:
            return self.text.op(f"load {runs.kind}, ptr {place}, align 8")
        name = f"llvm.masked.load.{runs.suffix}.p0"
        self.text.declarations.add(f"declare {runs.kind} @{name}(ptr, i32, {runs.flags}, {runs.kind})")
        return self.text.op(
            f"call {runs.kind} @{name}(ptr {place}, i32 8, {runs.flags} {mask}, {runs.kind} zeroinitializer)"
        )

    def _put(self, place: str, value: str, mask: str | None) -> None:
        runs = self.runs
        if mask is None:
            self.text.do(f"store {runs.kind} {value}, ptr {place}, align 8")
            return
        name = f"llvm.masked.store.{runs.suffix}.p0"
        self.text.declarations.add(f"declare void @{name}({runs.kind}, ptr, i32, {runs.flags})")
        self.text.do(f"call void @{name}({runs.kind} {value}, ptr {place}, i32 8, {runs.flags} {mask})")

    def _first_derivatives(self, index: str) -> None:
        text, numbers = self.text, self.model.numbers
        text.branch(text.op("icmp eq ptr %dx, null"), "compute", "take")
        text.begin("compute")
        self._derivatives(1)
        text.jump("computed")
        text.begin("take")
        places = [self._place("%dx", index, number) for number in numbers]

        def take(mask: str | None) -> None:
            for number, place in enumerate(places):
                self.cells.keep("k1", number, Number(self._get(place, mask), wide=True))

        self._whole_or_part("take", take)
        text.jump("computed")
        text.begin("computed")

    def _step(self, index: str) -> None:
        cells, states, tableau = self.cells, self.model.states, self.tableau
        for slot in self.scalars:
            cells.store(slot, Number(f"%g{slot}", wide=False))
        save(cells, states)
        self._first_derivatives(index)
        for stage in range(1, tableau.stages):
            advance(cells, states, tableau.a[stage], "%dt")
            moved = self.one.mul(self.one.add("%k", self.one.const(float(tableau.c[stage]))), "%dt")
            cells.store(T, Number(self.one.add("%t_base", moved), wide=False))
            self._derivatives(stage + 1)
        advance(cells, states, tableau.b, "%dt")

    def _derivatives(self, stage: int) -> None:
        values = LaneExpressions(self.runs, self.cells)
        for statement in self.model.statements:
            values.forget()
            value = values.value(statement.value)
            if isinstance(statement, Set):
                self.cells.store(statement.slot, value)
            else:
                self.cells.keep(f"k{stage}", statement.state, value)


def _piece(text: IrText) -> Piece:
    body, declared = text.body(), frozenset(text.declarations)
    name = "b" + blake2b("\n".join((body, *sorted(declared))).encode(), digest_size=10).hexdigest()
    numbers = ", ".join(f"double {number}" for number in _NUMBERS)
    arguments = f"ptr noalias %v, ptr noalias %dx, {numbers}"
    return Piece(name, f"define void @{name}({arguments}) #0 {{\n{body}\n}}", declared)
