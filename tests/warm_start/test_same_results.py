"""Started from what is stored, any program does what it did the first time."""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from desire_tui.engine.session import workspace
from tests.warm_start.starts import started

LINES = (
    "d/dt x = a*(y - x)", "d/dt y = -b*y + sin(x)", "d/dt z = u - z", "u = a*x", "u = u + 1", "v = u*u - f(x)", "w = v/x",
    "q = q + x", "if x - 1", "else", "end if", "OUT", "step", "u = ran()", "a = a + 1", "v = c[2]*x", "v = c[k]", "w = new*x",
    "w = func1(x; c)", "term y - 2", "type x, y", "d/dt y = 1/(x - x)", "store h = x", "invoke m(y, n)", "e = n + A", "JACOBIAN",
)  # fmt: skip
SCRIPTS = (
    "drun", "drun\ndrun", "irule 4 | drun", "drun | irule 2 | drun", "drun | a = 3 | x = 2 | drun", "drun\nk = 1\nnew = 2\ndrun",
    "drun | STOP", "drun second", "for i = 1 to 3 | a = i | drun | next", "irule 8 | drun", "irule 15 | drun", "drun | drun second",
)  # fmt: skip
DEFINITIONS = ("", "FUNCTION f(p$) = a*p$ - x\n", "SUBMODEL m(p$, q$)\nq$ = 2*p$ + new\nend\n")
HEAD = "TMAX = 0.2 | NN = 3 | DT = 0.05 | a = 1 | b = 2 | k = 3 | x = 1 | y = 1\nARRAY c[4], h[20] | c[1] = 1 | c[2] = 3\n"


@st.composite
def likely(draw):
    """A program that may well run."""
    lines = draw(st.lists(st.sampled_from(LINES), min_size=1, max_size=7))
    second = draw(st.sampled_from(["", "label second\nd/dt x = -x\ndispt x\n"]))
    shown = draw(st.sampled_from(["", "dispt x, y\n", "dispt x, u\n", "dispxy x, y\n"]))
    parts = (draw(st.sampled_from(DEFINITIONS)), HEAD, draw(st.sampled_from(SCRIPTS)), "\nDYNAMIC\n")
    return "".join(parts) + "\n".join(lines) + "\n" + shown + second


RESTORED = (
    "drun\nDYNAMIC\nd/dt x = a*(y - x)\nu = x*y\nd/dt y = -b*u\ndispt u, v\nv = u + y",
    "new = 1 | drun\nDYNAMIC\nu = f(x) + c[k]\nm(u, w)\nd/dt x = w - x\ntype x, w",
    "drun\nDYNAMIC\nVector h = tanh(h) + x\nd/dt x = h[1] - x\ndispt x",
    "drun\nDYNAMIC\nstep\nd/dt x = -x\nd/dt y = x\ndispt x, y",
    "irule 4 | drun\nDYNAMIC\nd/dt x = -x\nd/dt y = x - y\ndispxy x, y",
    "drun | drun second\nDYNAMIC\nd/dt x = -x\ndispt x\nlabel second\nd/dt y = -y\ndispt y",
)
NOT_STORED = (
    "drun\nDYNAMIC\nif x - 1\nu = 2*x\nend if\nd/dt x = -x\ndispt x",
    "drun\nDYNAMIC\nd/dt x = -x\ndispt x\nlabel other\nu = = 1",
    "drun\nDYNAMIC\nd/dt x = -x\ndispt x_",
    "go to 40\n30 x = 7\n40 drun\nDYNAMIC\nd/dt x = -x\ndispt x",
    "drun\nDYNAMIC\nd/dt x = -x\nd/dt c[1] = x\ndispt x",
    "drun\nDYNAMIC\nVectr d/dt c = -c\nd/dt x = -x",
    "irule 4 | drun\nDYNAMIC\nd/dt x = swtch(t - 0.07) - x\ndispt x",
    "irule 4 | drun\nDYNAMIC\nd/dt x = y - x\nd/dt y = 1\ny = 3*t\ndispt x",
    "drun\nDYNAMIC\nd/dt x = -x\nterm 0.9 - x\ndispt x",
    "irule 15 | drun\nDYNAMIC\nd/dt x = -x\ndispt x",
    "drun\nDYNAMIC\nd/dt x = ran() - x\ndispt x",
)
FAILS_AT_ZERO = """input b | x = 1 | TMAX = 1
drun
DYNAMIC
u = x/b
d/dt x = -x
d/dt y = -{0}
dispt {1}
"""


@pytest.mark.parametrize("text", RESTORED)
def test_of_programs_that_are_stored(stored, text):
    whole = "".join(DEFINITIONS) + HEAD + text + "\n"
    first, _ = started(whole)
    again, restored = started(whole)
    assert again == first
    assert restored


@pytest.mark.parametrize("text", NOT_STORED)
def test_of_programs_that_are_not(stored, text):
    first, _ = started(HEAD + text + "\n")
    assert not stored.exists()
    assert started(HEAD + text + "\n") == (first, False)


@pytest.mark.parametrize("shown", [("u", "x"), ("u", "u"), ("u*u", "x"), ("y", "x, u")])
def test_messages_of_runs_that_fail(stored, monkeypatch, shown):
    text = FAILS_AT_ZERO.format(*shown)
    started(text, "1")
    assert stored.exists()
    failed, _ = started(text, "0")
    monkeypatch.setattr(workspace, "STORED_LEAST", 10**6)
    assert started(text, "0")[0] == failed


@given(likely())
@settings(max_examples=20, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_of_any_program(stored, text):
    first, _ = started(text)
    again, _ = started(text)
    assert again == first
