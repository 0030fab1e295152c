"""What a check costs grows with the text, and no faster: steps are counted, not seconds."""

from __future__ import annotations

import difflib

import pytest

from desire_tui.engine.check import state_order as state_order_module
from desire_tui.engine.check.checker import check
from desire_tui.engine.check.state_order import state_order
from desire_tui.engine.lowering import submodels
from desire_tui.engine.source import Source
from desire_tui.engine.syntax.parse import parse
from tests.soak.programs import misspelt


def calls_of(monkeypatch, owner, name):
    """Return a list that grows by one with each call."""
    calls, function = [], getattr(owner, name)

    def counted(*args, **kwargs):
        calls.append(name)
        return function(*args, **kwargs)

    monkeypatch.setattr(owner, name, counted)
    return calls


def nested(levels: int, body: str = "d/dt x$ = -x$") -> str:
    """Return submodels each of which invokes the one before twice."""
    text = f"SUBMODEL s0(x$)\n{body}\nend\n"
    for level in range(1, levels):
        text += f"SUBMODEL s{level}(x$)\ninvoke s{level - 1}(x$)\ninvoke s{level - 1}(x$)\nend\n"
    return f"{text}x = 0 | NN = 3\ndrun\nDYNAMIC\ninvoke s{levels - 1}(x)\ndispt x"


def test_few_unknown_names_are_compared_with_all_known_ones(monkeypatch):
    comparisons = calls_of(monkeypatch, difflib, "get_close_matches")
    problems = check(parse(Source(misspelt(1, 200))))
    assert len(problems) >= 400
    assert len(comparisons) <= 20


@pytest.mark.parametrize("levels", [22, 60])
def test_submodels_are_counted_before_they_are_expanded(monkeypatch, levels):
    frames = calls_of(monkeypatch, submodels, "ExpansionFrame")
    (problem,) = check(parse(Source(nested(levels))))
    assert (problem.key, problem.code) == ("too-many-lines", 411)
    assert len(frames) < 10


def test_the_order_of_states_is_not_looked_for_in_submodels_without_end(monkeypatch):
    steps = calls_of(monkeypatch, state_order_module, "invocation")
    assert state_order(parse(Source(nested(22)))) == ()
    assert len(steps) < 10


def test_submodels_that_invoke_themselves_are_left_at_once(monkeypatch):
    text = "SUBMODEL a(x$)\n" + "invoke b(x$)\ninvoke a(x$)\n" * 3 + "end\n"
    text += "SUBMODEL b(x$)\n" + "invoke a(x$)\ninvoke b(x$)\n" * 3 + "end\n"
    program = parse(Source(f"{text}x = 0 | NN = 3\ndrun\nDYNAMIC\ninvoke a(x)\ninvoke b(x)\ndispt x"))
    frames = calls_of(monkeypatch, submodels, "ExpansionFrame")
    steps = calls_of(monkeypatch, state_order_module, "invocation")
    assert "submodel-recursion" in {problem.key for problem in check(program)}
    state_order(program)
    assert len(frames) < 60
    assert len(steps) < 60
