"""Boundary values among the states: which assignments count as such, and at what cost they are found."""

from __future__ import annotations

import pytest

from desire_tui.engine.lowering.lowering import lower
from desire_tui.engine.passes import assigned_states
from desire_tui.engine.source import Source
from desire_tui.engine.syntax.parse import parse
from desire_tui.engine.values import Values


def segment_of(body):
    return lower(parse(Source("DYNAMIC\n" + body)), None, Values())


@pytest.mark.parametrize(
    ("body", "left"),
    [
        ("x = t\nd/dt x = 1\nd/dt y = x", ["y"]),
        ("d/dt y = x\nx = t\nd/dt x = 1", ["y"]),  # read further up: computed earlier
        ("x = t\nx = 2*t\nd/dt x = 1\nd/dt y = x", ["x", "y"]),  # assigned twice
        ("x = 0.5*x\nd/dt x = 1\nd/dt y = x", ["x", "y"]),  # a difference equation
        ("x = ran()\nd/dt x = 1\nd/dt y = x", ["x", "y"]),  # earlier, it would draw in another order
        ("w = t\nx = w\nd/dt x = 1\nd/dt y = x", ["y"]),
        ("d/dt y = x\nw = t\nx = w\nd/dt x = 1", ["y", "x"]),  # cannot be computed earlier: w is not known
        ("if t - 1\nx = t\nproceed\nd/dt x = 1\nd/dt y = x", ["x", "y"]),  # at some passes only
    ],
)
def test_what_every_pass_assigns_is_no_state(body, left):
    segment = segment_of(body)
    smaller, numbers = assigned_states.without_assigned_states(segment, lambda count: 10**6)
    names = [states.name for states in segment.states]
    assert [names[number] for number in numbers] == left
    assert smaller.order == len(left)


def test_the_cost_grows_with_the_number_of_lines_not_with_its_square(monkeypatch):
    asked = 0

    def counted(action):
        nonlocal asked
        asked += 1
        return real(action)

    real = assigned_states.reads
    monkeypatch.setattr(assigned_states, "reads", counted)
    costs = []
    for count in (50, 200):
        lines = [f"x{k} = t + {k}" for k in range(count)]
        rates = [f"d/dt x{k} = x{(k + 1) % count}" for k in range(count + 1)]
        segment = segment_of("\n".join([*rates, *lines]))
        asked = 0
        assert len(assigned_states._assignments(segment)) == count
        costs.append(asked)
    assert costs[1] < 5 * costs[0]
