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
from desire_tui.engine.reference import learning, python_source
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
    """Move each result of an inexact function, each matrix of a product and each derivative to a neighbour, or not.

    A product whose sums cancel moves by far more than its last bit, as it does where sums are added in another order.
    """
    random = np.random.default_rng(seed)
    make_pass, derivatives = ReferenceModel._pass, StiffReferenceModel.derivatives
    build, write = ExpressionClosures._build, python_source._Expression._build
    learn_components = learning._learn_components

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
        if isinstance(value, MatVec):
            matrix, operand = made.func.__self__, made.args[0]
            return lambda: rounded(matrix).dot(operand)
        return (lambda: rounded(made())) if isinstance(value, Op) and value.name in INEXACT else made

    def rounded_components(out, weights, x, rate):
        weights[:] = rounded(weights)
        learn_components(out, weights, x, rate)

    def closures_instead(self, value, depth):
        if isinstance(value, Op) and value.name in INEXACT:
            raise python_source.CannotWriteError
        return write(self, value, depth)

    with (
        patch.object(ReferenceModel, "_pass", rounded_pass),
        patch.object(StiffReferenceModel, "derivatives", rounded_derivatives),
        patch.object(ExpressionClosures, "_build", rounded_values),
        patch.object(python_source._Expression, "_build", closures_instead),
        patch.object(learning, "_learn_components", rounded_components),
    ):
        yield
