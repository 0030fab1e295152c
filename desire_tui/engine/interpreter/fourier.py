"""`FFT` (language.md section 12; book, section 8.4 and Table 8.1), by NumPy's pocketfft."""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.interpreter.exception_mapping import ScriptFault
from desire_tui.engine.interpreter.interruptible import run_interruptibly

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from desire_tui.engine.interpreter.code_table import Operation
    from desire_tui.engine.interpreter.statement_context import StatementContext
    from desire_tui.engine.nodes.commands import Fft

WORK_PER_ELEMENT = 50
"""What a transform costs, in multiplications, roughly (`run_interruptibly`)."""
_ROOM_PER_ELEMENT = 8
"""Numbers that a transform holds at a time: copies, complex input, complex output."""


def fft(context: StatementContext, node: Fft) -> Operation:
    """Make the operation of an FFT statement; errors 61 (not a vector), 72 (length), 3 (overflow)."""
    count = context.truncated(node.args[0])
    quantities = [context.array(arg) for arg in node.args[1:]]
    for argument, quantity in zip(node.args[1:], quantities, strict=True):
        if len(quantity.shape) != 1:
            raise ScriptFault("fft-array", argument, name=quantity.name)
    views = [context.numbers(q) for q in quantities]

    def action() -> None:
        n = count()
        if n < 2:
            raise ScriptFault("fft-length", node.args[0], n=n)
        for argument, quantity in zip(node.args[1:], quantities, strict=True):
            if quantity.size < n:
                raise ScriptFault("fft-array-short", argument, name=quantity.name, size=quantity.size, n=n)
        for first, second in combinations(quantities, 2):
            if abs(first.slot - second.slot) < n:
                raise ScriptFault("fft-arrays-overlap", node, name=first.name, other=second.name)
        context.require_memory(_ROOM_PER_ELEMENT * n, node.args[0])
        parts = [view[:n].copy() for view in views]
        run_interruptibly(WORK_PER_ELEMENT * n, lambda: _transform(node.kind, parts), context.machine.check)
        if not all(np.isfinite(part).all() for part in parts):
            raise ScriptFault("overflow", node)
        for view, part in zip(views, parts, strict=True):
            view[:n] = part

    return context.then(action)


def _transform(kind: str, parts: list[NDArray[np.float64]]) -> None:
    with np.errstate(all="ignore"):  # the result is looked at
        _TRANSFORMS[kind](*parts)


def _forward(x: NDArray[np.float64], y: NDArray[np.float64]) -> None:
    transform = np.fft.fft(x + 1j * y)
    x[:], y[:] = transform.real, transform.imag


def _inverse(x: NDArray[np.float64], y: NDArray[np.float64]) -> None:
    signal = np.fft.ifft(x + 1j * y)
    x[:], y[:] = signal.real, signal.imag


def _two_real(
    x: NDArray[np.float64], y: NDArray[np.float64], u: NDArray[np.float64], v: NDArray[np.float64]
) -> None:
    first, second = np.fft.fft(x), np.fft.fft(y)
    x[:], u[:] = first.real, first.imag
    y[:], v[:] = second.real, second.imag


def _convolve(x: NDArray[np.float64], y: NDArray[np.float64]) -> None:
    product = np.fft.ifft(np.fft.fft(x) * np.fft.fft(y))
    x[:], y[:] = product.real, product.imag


_TRANSFORMS: dict[str, Callable[..., None]] = {"F": _forward, "I": _inverse, "R": _two_real, "C": _convolve}
