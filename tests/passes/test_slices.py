"""Which statements a pass executes."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st

from desire_tui.engine.lowered.statements import Deriv, Guard, Set
from desire_tui.engine.lowered.walk import walk_actions
from desire_tui.engine.passes.slices import (
    derivative_slice,
    final_sample_pass,
    full_pass,
    inner_slices,
    step_slice,
    without_derivatives,
)
from tests.lowering.programs import segment


def names(actions, values):
    """Names assigned (or `d` and the state's number) in order."""
    by_slot = {q.slot: q.name for q in values if not q.shape}
    shown = []
    for action in walk_actions(actions):
        if isinstance(action, Guard):
            shown.append(action.kind)
        elif isinstance(action, Deriv):
            shown.append(f"d{action.state}")
        elif isinstance(action, Set):
            shown.append(by_slot[action.slot])
        else:
            shown.append(type(action).__name__)
    return shown


BODY = """
shown = 2*x
used = 3*x
relay = sgn(relay - x)
noise = ran()
d/dt x = used
term x - 1
OUT
out = shown
step
held = x
"""


def test_each_pass():
    lowered, values = segment(BODY)
    assert names(full_pass(lowered), values) == [
        "shown", "used", "relay", "noise", "d0", "Terminate", "out", "held",
    ]  # fmt: skip
    assert names(step_slice(lowered), values) == ["used", "relay", "noise", "d0", "Terminate"]
    assert names(derivative_slice(lowered), values) == ["used", "relay", "noise", "d0"]
    assert names(final_sample_pass(lowered), values) == ["shown", "used", "out"]


def test_an_if_stays_where_something_needs_it():
    lowered, values = segment("if a\ny = 1\nelse\ny = 2\nend if\nif a\nq = 3\nend if\nd/dt x = y", a=1)
    assert names(derivative_slice(lowered), values) == ["if", "y", "y", "d0"]


def test_what_only_the_step_needs():
    lowered, values = segment("y = 2*x\nd/dt x = h\nstep\nh = y", h=0)
    assert names(derivative_slice(lowered), values) == ["d0"]
    assert names(step_slice(lowered), values) == ["y", "d0", "h"]


def test_history_statements():
    body = "get u = U\nd/dt x = u\ntdelay y = D(x, 0.1\ndelay z = E(x, 0.1\nstore X = x"
    lowered, values = segment(body, U=(5,), X=(5,), D=(5,), E=(5,))
    assert names(full_pass(lowered), values) == ["GetHistory", "d0", "DelayLine", "DelayLine", "StoreHistory"]
    assert names(step_slice(lowered), values) == ["d0", "DelayLine"]
    assert names(derivative_slice(lowered), values) == ["d0"]
    assert names(final_sample_pass(lowered), values) == ["GetHistory", "DelayLine", "StoreHistory"]


def test_vectors_are_sliced_too():
    body = (
        "Vector u = 2*s\nVector w = 3*s\nDOT m = w*1\nVectr d/dt s = u\ny = s[1]\nd/dt z = q[2]\nVector q = s"
    )
    lowered, values = segment(body, u=(3,), w=(3,), s=(3,), q=(3,))
    assert names(derivative_slice(lowered), values) == ["SetVec", "DerivVec", "d3", "SetVec"]


PARTS = (
    "used = 3*x", "relay = sgn(relay - w)", "noise = ran()", "term x - 1", "w = used + relay", "if x\nw = relay\nend if",
    "tdelay p = D(w, 0.1)", "d/dt z = w + p", "trkhld h, h0 = x, w",
)  # fmt: skip


@settings(max_examples=40)
@given(st.lists(st.sampled_from(PARTS), unique=True), st.sampled_from(["", "OUT\nout = w", "step\nheld = w"]))
def test_both_inner_passes_at_once_are_what_they_are_one_by_one(lines, end):
    numbers = dict.fromkeys(("used", "relay", "w", "p", "z", "h", "h0"), 1)
    lowered, _ = segment("\n".join([*lines, "d/dt x = relay", end]), D=(9,), **numbers)
    assert inner_slices(lowered) == (derivative_slice(lowered), step_slice(lowered))


def test_inner_passes_that_are_the_same_are_found_once():
    stage, step = inner_slices(segment("u = 2*x\nd/dt x = u")[0])
    assert stage is step
    stage, step = inner_slices(segment("u = 2*x\nd/dt x = u\nterm u - 1")[0])
    assert [len(stage), len(step)] == [2, 3]


@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.tuples(st.integers(0, 5), st.lists(st.integers(0, 5), max_size=3)), min_size=1, max_size=8)
)
def test_leaving_out_changes_no_derivative(lines):
    """Both-flags-off passes: the slice gives the derivatives and persistent numbers of the whole segment."""
    import numpy as np

    from desire_tui.engine.reference.statements import StatementClosures

    body = "\n".join(
        f"v{target} = 0.5 + " + " + ".join([f"0.25*v{s}" for s in sources] or ["x"])
        for target, sources in lines
    )
    body += "\nd/dt x = v0 - v3 + x"
    initial = {f"v{i}": 0.1 * i for i in range(6)}
    whole, values = segment(body, x=1.5, **initial)
    kept, other = segment(body, x=1.5, **initial)
    results = []
    for actions, quantities in ((whole.body, values), (derivative_slice(kept), other)):
        statements = StatementClosures(quantities, 1)
        passes = statements.compile(actions)
        for _ in range(3):
            passes()
        persistent = [quantities.cells[a.slot] for a in whole.body if isinstance(a, Set) and a.persistent]
        results.append([*statements.derivatives, *persistent])
    assert np.array_equal(*results)


def test_derivatives_left_out_but_for_those_that_draw():
    """A solver computes its own; the random numbers of a pass stay the same ones."""
    made, values = segment("q = 2*x\nd/dt x = -q\nd/dt y = ran()\nif a\nr = q\nend if", a=1)
    assert names(full_pass(made), values) == ["q", "d0", "d1", "if", "r"]
    assert names(without_derivatives(full_pass(made)), values) == ["q", "d1", "if", "r"]
