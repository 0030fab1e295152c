"""A segment's passes as C functions, for loops that others drive (rules 9 … 16; tangents and Jacobians)."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.codegen.ir.text import IrText
from desire_tui.engine.codegen.ir.work_memory import WorkMemory, context_fields
from desire_tui.engine.codegen.jit.piece import Piece
from desire_tui.engine.codegen.pieces.piece_tables import ENTRY_BYTES, PieceTables
from desire_tui.engine.digest import blake2b

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from desire_tui.engine.codegen.jit.cache import CodeCache, Compiled
    from desire_tui.engine.lowered.statements import Action
    from desire_tui.engine.values import Values


class PassFunctions:
    """C functions `int64 f(RunMemory *memory, double *k)`, one for each of `passes` (name → statements).

    A function runs the pass with t, states and everything else where they stand in the values, and returns 0,
    or 1 + the number of the `term` that fired. Derivatives go to `k` (`order` numbers) or, for those named in
    `own`, whose second argument is not looked at, to `self.k1`. Addresses stay valid, and faster code comes
    into use behind them, as long as this object lives; hand it to `Improver.add` for that.
    """

    def __init__(
        self,
        store: CodeCache,
        values: Values,
        order: int,
        passes: Mapping[str, tuple[Action, ...]],
        own: frozenset[str] = frozenset({"step", "full", "tail"}),
    ) -> None:
        self.k1 = np.zeros(max(order, 1))
        self._tables = PieceTables(store, passes)
        self.kind = self._tables.kind
        self._temps = np.zeros(self._tables.temps)
        self._context = WorkMemory(
            values=values.address, k1=self.k1.ctypes.data, temps=self._temps.ctypes.data, states=order
        )
        written = {name: self._function(name, own=name in own) for name in passes}
        found = store.quick(written.values())
        self._code: dict[str, Compiled] = {name: found[piece.name] for name, piece in written.items()}

    def address(self, name: str) -> int:
        """Return a function's address."""
        return self._code[name].address

    def call(self, name: str, memory: ctypes.Structure, k: int = 0) -> int:
        """Call a function from Python."""
        function = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_void_p, ctypes.c_void_p)(self.address(name))
        return int(function(ctypes.addressof(memory), k))

    def improve(self) -> Iterator[None]:
        """Compile fast code (`background.Improvable`)."""
        return self._tables.improve()

    def _function(self, name: str, *, own: bool) -> Piece:
        text = IrText()
        fields = context_fields(text)
        text.do(f"%c = inttoptr i64 {ctypes.addressof(self._context)} to ptr")
        fields.store("memory", "%m")
        fields.store("term", "-1")
        text.do(f"%v = load ptr, ptr {fields.at('values')}")
        if own:
            text.do(f"%dx = load ptr, ptr {fields.at('k1')}")
        text.do(f"%table = inttoptr i64 {self._tables.addresses[name]} to ptr")
        call_table(text, "%table", "%k" if not own else "%dx")
        result = text.op(f"add i64 {fields.load('term')}, 1")
        text.do(f"ret i64 {result}")
        body = text.body()
        digest = "f" + blake2b(body.encode(), digest_size=10).hexdigest()
        return Piece(digest, f"define i64 @{digest}(ptr %m, ptr %k) #0 {{\n{body}\n}}", frozenset())


def call_table(text: IrText, table: str, derivatives: str) -> None:
    """Write calls of all pieces of a table; `%v` and `%c` must be there."""
    stem = text.fresh()
    text.jump(f"{stem}.pre")
    text.begin(f"{stem}.pre")
    text.jump(f"{stem}.head")
    text.begin(f"{stem}.head")
    text.do(f"%{stem}.at = phi ptr [ {table}, %{stem}.pre ], [ %{stem}.next, %{stem}.call ]")
    text.do(f"%{stem}.piece = load volatile ptr, ptr %{stem}.at")
    text.branch(text.op(f"icmp eq ptr %{stem}.piece, null"), f"{stem}.done", f"{stem}.call")
    text.begin(f"{stem}.call")
    data = text.op(f"load ptr, ptr {text.op(f'getelementptr i8, ptr %{stem}.at, i64 8')}")
    text.do(f"call void %{stem}.piece(ptr %v, ptr {derivatives}, ptr %c, ptr {data})")
    text.do(f"%{stem}.next = getelementptr i8, ptr %{stem}.at, i64 {ENTRY_BYTES}")
    text.jump(f"{stem}.head")
    text.begin(f"{stem}.done")
