"""A model's recurrences as compiled code: quick code first, fast code in its place when that is there."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir.shared_loops import is_large
from desire_tui.engine.codegen.taylor.layout import Layout
from desire_tui.engine.codegen.taylor.recurrences import recurrences
from desire_tui.engine.codegen.taylor.straight_line import is_small, straight_line
from desire_tui.engine.codegen.threads.pool import thread_pool

if TYPE_CHECKING:
    from collections.abc import Iterator

    from desire_tui.engine.codegen.jit.cache import CodeCache
    from desire_tui.engine.codegen.jit.machine_code import MachineCode
    from desire_tui.engine.integration.taylor.memory import Taylor
    from desire_tui.engine.passes.series.nodes import SeriesProgram

_PIECES_MOST = 64
"""Pieces that states may consist of where they are shared: each block looks through all."""
_TEXT_MOST = 400_000
"""Characters of a function that LLVM is asked to compile well: its time grows with their square."""


class SeriesCode:
    """Recurrences of a program; `give` puts them into use."""

    def __init__(self, code: CodeCache, program: SeriesProgram) -> None:
        self.layout = Layout(program)
        self._store, self._program = code, program
        self._quick, self.values_pass = recurrences(program, self.layout)
        self._straight = f"{self._quick.name}s" if is_small(program) else None
        """Name of the function without a loop, whose bits are those of the loop over the order."""
        known = self._straight and code.find(self._straight, fast=True)
        self._compiled = [known or code.quick([self._quick])[self._quick.name]]
        self._users: list[Taylor] = []

    def give(self, taylor: Taylor) -> None:
        """Let a solver call the recurrences, from now on the best that there are."""
        self._users.append(taylor)
        taylor.recurrences = self._compiled[-1].address

    def improve(self) -> Iterator[None]:
        """Compile fast code (`background.Improvable`); where that would take minutes quick code has to do."""
        if self._straight is not None:
            better = self._store.find(self._straight, fast=True) or self._store.fast(
                straight_line(self._program, self.layout, self._straight), passes=False
            )
        elif len(self._quick.text) <= _TEXT_MOST:
            # what may be done side by side is arrays already
            better = self._store.fast(self._quick, slp=False)
        else:
            return
        self._compiled.append(better)
        for taylor in self._users:
            taylor.recurrences = better.address  # one aligned store: who calls sees the old or the new
        yield


def share_steps(taylor: Taylor, solver: MachineCode) -> None:
    """Let threads share what a solver does with each of many states; `solver`: the code of `shared_steps`."""
    if is_large(taylor.n) and taylor.piece_count <= _PIECES_MOST:
        taylor.share = thread_pool().share
        taylor.scan_block = solver.address("solver_scan_block")
        taylor.move_block = solver.address("solver_move_block")
