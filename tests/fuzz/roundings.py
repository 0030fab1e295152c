"""Runs of the reference back end with other roundings: how much of a result is rounding's alone.

The sines of two libraries differ in the last bit, and so do sums that are added in another order. That decides where a
rule compares a test difference with its bound: on the other side it goes on with another step, the runs then
differ by as much as ERMAX allows, and DT by a factor. And it grows where a program feeds a steep function with its own
values. Nobody is wrong then, and no tolerance tells it from a fault. What tells is the program: if other roundings
move the reference's result as far, the difference says nothing.
"""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Any
from unittest.mock import patch

import numpy as np

from desire_tui.engine.lowered.expressions import MatVec, Op
from desire_tui.engine.reference import python_source
from desire_tui.engine.reference.expressions import ExpressionClosures
from desire_tui.engine.reference.model import ReferenceModel
from desire_tui.engine.reference.stiff import StiffReferenceModel

if TYPE_CHECKING:
    from collections.abc import Iterator

ROUNDING = 2.0**-52
INEXACT = frozenset(
    "sin cos tan asin acos atan atan2 sinh cosh tanh exp ln log pow sinc sigmoid".split()  # noqa: SIM905
)
"""Functions that libraries round differently; the others give the same bits everywhere."""


@contextmanager
def other_roundings(seed: int) -> Iterator[None]:
    """Move each result of an inexact function, each product of a matrix and each derivative to a neighbour, or not."""
    random = np.random.default_rng(seed)
    make_pass, derivatives = ReferenceModel._pass, StiffReferenceModel.derivatives
    build, write = ExpressionClosures._build, python_source._Expression._build

    def rounded(x: Any) -> Any:
        return x * (1.0 + ROUNDING * random.integers(-1, 2, np.shape(x)))

    def rounded_pass(self, statements, memory):
        make_pass(self, statements, memory)
        for k in self.states.k:
            k[:] = rounded(k)

    def rounded_derivatives(self, t, y, out):
        derivatives(self, t, y, out)
        out[:] = rounded(out)

    def rounded_values(self, value):
        made = build(self, value)
        inexact = isinstance(value, MatVec) or (isinstance(value, Op) and value.name in INEXACT)
        return (lambda: rounded(made())) if inexact else made

    def closures_instead(self, value, depth):
        if isinstance(value, Op) and value.name in INEXACT:
            raise python_source.CannotWriteError
        return write(self, value, depth)

    with (
        patch.object(ReferenceModel, "_pass", rounded_pass),
        patch.object(StiffReferenceModel, "derivatives", rounded_derivatives),
        patch.object(ExpressionClosures, "_build", rounded_values),
        patch.object(python_source._Expression, "_build", closures_instead),
    ):
        yield
