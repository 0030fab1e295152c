"""CLEARN, PLEARN and INTP on both back ends, and against what they are for."""

import numpy as np
import pytest

from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source
from tests.codegen.conftest import Made, run

START = (
    "m = 4 | n = 3 | SEED 2 | ARRAY W[m,n], x[n], v[m], h[m]\nfor i = 1 to m | h[i] = i | next\n"
    "for i = 1 to m | for k = 1 to n | W[i,k] = {w} | next | next\n"
    "NN = 200\ndrun\nDYNAMIC\nVector x = ran()\n"
)


def learned(text, backend):
    """Run until the end, or until no template is left."""
    session, codes = Session(backend=backend), [232]
    try:
        session.erun(Source(text))
    except DesireError as error:
        codes = [d.code for d in error.diagnostics]
    assert codes == [232]
    record = session.runs[-1]
    return Made(record.rows[: record.count].copy(), session, record)


@pytest.mark.parametrize("w", ["0.1*ran()", "0", "0.3*(i - 2)"])
@pytest.mark.parametrize(
    "statement",
    [
        "CLEARN v = W(x) 0.1, 0",
        "CLEARN v = W(x) -0.1, 0",
        "CLEARN v = W(x) 0.1, 0.6",
        "CLEARN v = W*x; 0, -1#",
        "CLEARN v = W(x) sqrt(t - 3), -1",
        "CLEARN v = W(x) 0.1, ln(50 - t)",
        "CLEARN v = W(x) 0.1, 0.3#",
        "PLEARN v = W*x; 0.02",
        "INTP v = W*x; 0.1",
    ],
)
def test_back_ends_agree(statement, w):
    text = START.format(w=w) + f"{statement}\nDOT s = v*1\ndispt s\n"
    native, reference = learned(text, "native"), learned(text, "reference")
    for name in "Wvh":
        np.testing.assert_allclose(native.array(name), reference.array(name), rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(native.rows, reference.rows, rtol=1e-9, atol=1e-12)


def test_winners_move_to_the_means_of_their_clusters():
    made = run(
        "SEED 4 | ARRAY W[2,2], x[2], v[2]\nW[1,1] = 0.5 | W[2,2] = 0.5\nNN = 4000\ndrun\nDYNAMIC\n"
        "side = swtch(ran())\nx[1] = side + 0.1*ran()\nx[2] = 1 - side + 0.1*ran()\n"
        "CLEARN v = W(x) 0.02, -1\nDOT s = v*1\ndispt s\n"
    )
    np.testing.assert_allclose(made.array("W"), np.eye(2), atol=0.05)
    assert set(made.rows[:, 1]) == {1.0}
