"""Functions and tables of what all runs share (`cos(om*t)`): the first group computes them, the others look.

All groups go through the same times, so the k-th step of each computes them of the same arguments. Beside
each result its arguments are kept and compared, so that nothing depends on that: where they differ, the
value is computed.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.codegen.ir.lanes import Lanes

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from desire_tui.engine.codegen.ir.text import IrText

_BYTES_MOST = 1 << 19
"""Kept at most, by each thread: half of what a core's second cache holds."""
_NOTHING = -1
"""The bits of a nan that nothing computes; also those of its functions' values."""


class SharedValues:
    """Writes look-ups. Parameters of the function: `%shared`, the memory; `%kept`, steps that it holds."""

    def __init__(self, text: IrText, counter: str) -> None:
        """`counter`: the variable that tells steps apart."""
        self._text, self._counter = text, counter
        self.words = 0
        """Numbers kept of each step."""

    def value(self, arguments: Sequence[str], compute: Callable[[], str]) -> str:
        """Return what is kept for these arguments, or what `compute` writes."""
        text = self._text
        place = self._place(1 + len(arguments))
        cell = text.alloca("double")
        places = [text.op(f"getelementptr double, ptr {place}, i64 {k}") for k in range(1 + len(arguments))]
        same = "true"
        for at, argument in zip(places[1:], arguments, strict=True):
            bits = text.op(f"bitcast double {argument} to i64")
            equal = text.op(f"icmp eq i64 {bits}, {text.op(f'load i64, ptr {at}')}")
            same = text.op(f"and i1 {same}, {equal}")
        text.declarations.add("declare i1 @llvm.expect.i1(i1, i1)")
        same = text.op(f"call i1 @llvm.expect.i1(i1 {same}, i1 true)")
        look, find, on = (f"{stem}{text.fresh()}" for stem in ("look", "find", "on"))
        text.branch(same, look, find)
        text.begin(find)
        value = compute()
        for at, number in zip(places, (value, *arguments), strict=True):
            text.do(f"store double {number}, ptr {at}")
        text.do(f"store double {value}, ptr {cell}")
        text.jump(on)
        text.begin(look)
        text.do(f"store double {text.op(f'load double, ptr {places[0]}')}, ptr {cell}")
        text.jump(on)
        text.begin(on)
        return text.op(f"load double, ptr {cell}")

    def _place(self, words: int) -> str:
        """Return where so many numbers of this step are; all steps behind those kept have one place."""
        text = self._text
        step = text.op(f"load i64, ptr %l.{self._counter}")
        step = text.op(f"select i1 {text.op(f'icmp ult i64 {step}, %kept')}, i64 {step}, i64 %kept")
        own = text.op(f"mul i64 {step}, {words}")
        room = text.op("add i64 %kept, 1")
        before = text.op(f"mul i64 {room}, {self.words}")
        self.words += words
        return text.op(f"getelementptr double, ptr %shared, i64 {text.op(f'add i64 {before}, {own}')}")


class SharedLanes(Lanes):
    """Numbers of all runs, whose functions are computed once."""

    __slots__ = ("values",)

    def __init__(self, values: SharedValues, text: IrText) -> None:
        super().__init__(text)
        self.values = values

    def call_library(self, name: str, *args: str) -> str:
        """Look the value up, or call a function of the mathematical library."""
        return self.values.value(args, lambda: super(SharedLanes, self).call_library(name, *args))


class SharedMemory:
    """The memory of the look-ups, for `words` numbers of each step."""

    def __init__(self, words: int) -> None:
        self._words = words
        self._numbers = np.empty(0, dtype=np.int64)
        self.kept = 0
        """Steps that it holds."""

    def cleared(self, steps: float) -> NDArray[np.int64]:
        """Return memory that holds nothing, for runs of about so many steps, perhaps infinitely many."""
        self.kept = int(min(_BYTES_MOST // (8 * self._words), steps)) if self._words else 0
        wanted = (self.kept + 1) * self._words
        if len(self._numbers) < wanted:
            self._numbers = np.empty(wanted, dtype=np.int64)
        self._numbers[:wanted] = _NOTHING
        return self._numbers
