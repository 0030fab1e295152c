"""Plain equations are lowered without ceremony: what comes out is what the ordinary way makes of them."""

from __future__ import annotations

from unittest.mock import patch

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from desire_tui.engine.lowering import lowering_cache, segments
from desire_tui.engine.lowering.plain_lines import lower_plain_lines
from desire_tui.engine.nodes.segment import Derivative
from desire_tui.engine.quick_tuples import tuples
from desire_tui.engine.source import Span
from tests.lowering.test_lowering_cache import NAMES, SCRIPTS, outcome

LINES = (
    "d/dt x = a*(y - x)", "d/dt y = -b*y + sin(x)^2", "d/dt y = +x", "d/dt x[2] = y", "d/dt PI = 1", "d/dt f = 1",
    "u = a*x", "u = u + 1", "v = u*u - f(x)", "w = v + max(u, a)/2", "y = 3 - -2", "u = mod(x, 2) + ceil(y)", "t = x",
    "u = ran() + max(x)", "v = atan2(x, q)", "if x - 1", "else", "end if", "OUT", "step", "recover u",
    "Vectr d/dt c = a*c", "v = c", "d/dt c = x", "x = 2*y", "s(u, x)", "event x - 1", "v = " + " + ".join(["x*x"] * 120),
)  # fmt: skip
SUBMODEL = "SUBMODEL s(p$, q$)\np$ = a*q$\nd/dt q$ = p$\nend\n"


def ordinary(text, names, arrays):
    """Lower with nothing in the caches, every line in the ordinary way."""
    lowering_cache.forget()
    with (
        patch.object(segments, "lower_plain_lines", lambda _builder, _lines, at: at),
        patch.object(segments, "scalar_states", lambda _context, _lines: None),
    ):
        found = outcome(text, names, arrays)
    lowering_cache.forget()
    return found


@settings(max_examples=60)
@given(
    lines=st.lists(st.sampled_from(LINES), min_size=1, max_size=12),
    script=st.sampled_from((*SCRIPTS, SUBMODEL)),
    names=NAMES,
    arrays=st.sets(st.sampled_from(["c", "a"])),
)
def test_both_ways_come_to_the_same(lines, script, names, arrays):
    text = f"{script}DYNAMIC\n" + "\n".join(lines) + "\n"
    expected = ordinary(text, names, arrays)
    assert outcome(text, names, arrays) == expected
    assert outcome(text, names, arrays) == expected  # from the cache


@settings(max_examples=20)
@given(
    st.dictionaries(st.integers(0, 39), st.sampled_from(LINES), max_size=3),
    st.dictionaries(st.integers(0, 39), st.sampled_from(LINES), max_size=2),
    st.permutations(["a", "b", "u"]),
    st.integers(2, 3),
)
@example({}, {20: "d/dt x = 2"}, ["b", "a", "u"], 2)
@example({30: "u = 2*x"}, {}, ["b", "u", "a"], 3)
def test_an_edit_of_a_long_program_comes_to_the_same(odd, edit, others, given_names):
    """Most derivatives are known from the first text, where parameters may have had other slots."""
    lines = [odd.get(k, f"d/dt x{k} = a*(b - x{(7 * k) % 40})") for k in range(40)]
    edited = [edit.get(k, line) for k, line in enumerate(lines)]
    expected = ordinary("\n".join(["DYNAMIC", *edited, ""]), others[:given_names], set())
    outcome("\n".join(["DYNAMIC", *lines, ""]), ["a", "b", "u"], set())
    assert outcome("\n".join(["DYNAMIC", *edited, ""]), others[:given_names], set()) == expected


@pytest.mark.parametrize("line", ["d/dt x = a*(1 - x)", "u = sin(a)"])
def test_plain_lines_go_this_way(line):
    with patch.object(segments, "lower_plain_lines", wraps=lower_plain_lines) as plain:
        outcome(f"a = 1\ndrun\nDYNAMIC\n{line}\nd/dt y = 1\n", ["a"], set())
    calls = [(call.args[1], call.args[2]) for call in plain.call_args_list]
    assert [at for _, at in calls] == [0, 0]  # the check's, the run's: both lines at once
    assert all(isinstance(lines[1][0], Derivative) for lines, _ in calls)


def test_tuples_are_records():
    made = [*tuples(Span, [1, 2], [3, 4])]
    assert made == [Span(1, 3), Span(2, 4)]
    assert {type(span) for span in made} == {Span}
