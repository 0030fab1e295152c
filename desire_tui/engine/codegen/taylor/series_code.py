"""A model's recurrences as compiled code: quick code first, fast code in its place when that is there."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.taylor.layout import Layout
from desire_tui.engine.codegen.taylor.recurrences import recurrences
from desire_tui.engine.codegen.taylor.straight_line import straight_line

if TYPE_CHECKING:
    from collections.abc import Iterator

    from desire_tui.engine.codegen.jit.cache import CodeCache
    from desire_tui.engine.integration.taylor.memory import Taylor
    from desire_tui.engine.passes.series.nodes import SeriesProgram

_TEXT_MOST = 400_000
"""Characters of a function that LLVM is asked to compile well: its time grows with their square."""


class SeriesCode:
    """Recurrences of a program; `give` puts them into use."""

    def __init__(self, code: CodeCache, program: SeriesProgram) -> None:
        self.layout = Layout(program)
        self._store = code
        quick = recurrences(program, self.layout)
        self._piece = straight_line(program, self.layout) or quick
        """What fast code is made of; its bits are those of the loop over the order."""
        self._compiled = [code.find(self._piece.name, fast=True) or code.quick([quick])[quick.name]]
        self._users: list[Taylor] = []

    def give(self, taylor: Taylor) -> None:
        """Let a solver call the recurrences, from now on the best that there are."""
        self._users.append(taylor)
        taylor.recurrences = self._compiled[-1].address

    def improve(self) -> Iterator[None]:
        """Compile fast code (`background.Improvable`); where that would take minutes quick code has to do."""
        if len(self._piece.text) > _TEXT_MOST:
            return
        better = self._store.fast(self._piece, slp=False)  # what may be done side by side is arrays already
        self._compiled.append(better)
        for taylor in self._users:
            taylor.recurrences = better.address  # one aligned store: who calls sees the old or the new
        yield
