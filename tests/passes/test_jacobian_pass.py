"""The pass that fills a JACOBIAN's array: what its elements use is computed, in the branch that holds now."""

from __future__ import annotations

import numpy as np
import pytest

from desire_tui.engine.passes.slices import jacobian_pass
from desire_tui.engine.reference.statements import StatementClosures
from tests.lowering.programs import segment

UNDER_IF = """
if x - 1
k = 2*y
else
k = 5
end if
shown = 7*x
d/dt x = -k*x
d/dt y = x*y
OUT
z = shown
JACOBIAN
slope = -k
J[1, 1] = slope
J[1, 2] = -2*x*swtch(x - 1)
J[2, 1] = y
J[2, 2] = x
"""


def filled(body, **states):
    """The array after one JACOBIAN pass with these states."""
    lowered, values = segment(body, J=(2, 2), k=0, **states)
    statements = StatementClosures(values, lowered.order)
    statements.compile(jacobian_pass(lowered, lowered.order))()
    return values.view(values.find("J")).copy(), statements, values


@pytest.mark.parametrize(
    ("x", "y", "expected"),
    [(3, 4, [[-8, -6], [4, 3]]), (0.5, 4, [[-5, 0], [4, 0.5]])],
)
def test_numbers_set_under_an_if(x, y, expected):
    """∂x'/∂x = -2y and ∂x'/∂y = -2x above x = 1, -5 and 0 below; ∂y'/∂x = y, ∂y'/∂y = x."""
    found, statements, _ = filled(UNDER_IF, x=x, y=y)
    assert found.tolist() == expected
    assert not statements.derivatives.any()  # it is no derivative pass


def test_only_what_the_elements_use_is_computed():
    _, _, values = filled(UNDER_IF, x=3, y=4)
    assert values.cells[values.find("shown").slot] == 0
    assert values.cells[values.find("z").slot] == 0


def test_a_long_sum_is_computed_before_the_number_that_needs_it():
    """Long chains become pieces in front of their statement (`long_chains`)."""
    body = (
        "d/dt x = -x\nd/dt y = -y\nJACOBIAN\nslope = -1 + "
        + " + ".join(["0*x"] * 400)
        + "\nJ[1, 1] = slope\n"
    )
    found, _, _ = filled(body + "J[2, 2] = -1 + " + " + ".join(["0*y"] * 400), x=1, y=1)
    assert np.array_equal(found, [[-1, 0], [0, -1]])
