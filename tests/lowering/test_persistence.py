"""Which assignments are carried out in every pass, where arrays, their elements and their views meet."""

from __future__ import annotations

from time import thread_time

import pytest

from desire_tui.engine.lowered.segment import StateRange
from desire_tui.engine.lowered.statements import Set, SetVec
from desire_tui.engine.lowered.walk import walk_actions
from desire_tui.engine.lowering.lowering import lower
from desire_tui.engine.lowering.states import StateTable
from desire_tui.engine.syntax.parse import parse
from desire_tui.engine.values import Quantity, Values
from tests.lowering.programs import segment, source


def persistent(body, **arrays):
    """Whether each assignment of a segment persists, in order."""
    lowered, _ = segment(body, **arrays)
    return [action.persistent for action in walk_actions(lowered.body) if isinstance(action, Set | SetVec)]


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ("Vector a = 1\nDOT s = a*1", [False]),
        ("a[1] = 1\ny = a[1]", [False, False]),
        ("y = a[1]\na[1] = 1", [False, True]),
        ("y = a[2]\na[1] = 1", [False, False]),
        ("DOT s = a*1\na[3] = 1", [True]),
        ("a[1] = 1\nDOT s = a*1", [True]),  # of three numbers one is set: the others are those of before
        ("y = a[3]\nVector a = 1", [False, True]),
        ("y = a[1]\nVector a = 1", [False, True]),
        ("y = b[1]\nVector a = 1", [False, False]),
        ("Vector a = 1\ny = a[3]", [False, False]),
        # what only one branch sets may be that of a pass before
        ("if t\nVector a = 1\nelse\nVector b = 1\nend if\nDOT s = a*1", [True, False]),
        ("if t\nVector b = 1\nelse\nVector a = 1\nend if\nDOT s = a*1", [False, True]),
        ("if t\nVector a = 1\nelse\nVector a = 2\nend if\nDOT s = a*1", [False, False]),
        ("if t\na[1] = 1\nelse\nb[1] = 1\nend if\ny = a[1]", [True, False, False]),
        ("if t\nb[1] = 1\nelse\na[1] = 1\nend if\ny = a[1]", [False, True, False]),
        ("if t\na[1] = 1\nelse\na[1] = 2\nend if\ny = a[1]", [False, False, False]),
    ],
)
def test_elements_and_whole_vectors(body, expected):
    assert persistent(body, a=(3,), b=(3,)) == expected


def test_a_range_of_states_stands_where_its_first_line_stands():
    """`d/dt v[2]`, `d/dt z`, `Vectr d/dt v`: v is named by its longest line and numbered by its first."""
    lines = [
        StateRange("v[2]", 11, 0, 1, None),
        StateRange("z", 5, 1, 1, None),
        StateRange("v", 10, 2, 3, None),
    ]
    table = StateTable(lines)
    assert [(r.name, r.slot, r.first, r.count) for r in table.ranges] == [("v", 10, 0, 3), ("z", 5, 3, 1)]
    assert [table.number(slot) for slot in (10, 11, 12, 5, 13, 9)] == [0, 1, 2, 3, None, None]


def test_a_short_view_inside_a_long_one_ends_nothing():
    """Ranges 10 … 19, 12 … 13 and 18 … 21: one range of twelve."""
    spans = [("a", 10, 10), ("b", 12, 2), ("c", 18, 4)]
    table = StateTable(
        [StateRange(name, slot, i, count, None) for i, (name, slot, count) in enumerate(spans)]
    )
    assert [(r.slot, r.count) for r in table.ranges] == [(10, 12)]


def test_subscripts_are_truncated():
    """language.md 3: 2.7 is element 2, of a matrix too; they are evaluated once."""
    lowered, values = segment("y = a[2.7]\nz = W[1.9, k]", a=(3,), W=(2, 3), k=2.999)
    a, w = values.find("a").slot, values.find("W").slot
    assert [action.value.slot for action in lowered.body] == [a + 1, w + 1]


def test_a_view_is_set_where_all_of_its_parts_are():
    """p and q are the two halves of z: with p set alone, reading z reads the q of the pass before."""
    text = "{}\nDOT s = z*1"
    found = []
    for body in ("Vector p = 1", "Vector p = 1\nVector q = 2"):
        values = Values()
        first = values.array("p", (8,)).slot  # as many numbers as a cache line: q follows at once
        assert values.array("q", (8,)).slot == first + 8
        values.names["z"] = Quantity("z", first, (16,))
        lowered = lower(parse(source("DYNAMIC\n" + text.format(body))), None, values)
        found.append([action.persistent for action in lowered.body if isinstance(action, SetVec)])
    assert found == [[True], [False, False]]


def test_an_if_costs_what_stands_in_it_not_what_stands_before_it():
    """Every if of a long segment once copied all names that were set."""

    def seconds(ifs: int) -> float:
        text = "".join(f"if t - {k}\ny{k} = 1\nelse\ny{k} = 2\nend if\n" for k in range(ifs))
        began = thread_time()
        segment(text)
        return thread_time() - began

    seconds(10)
    assert seconds(4000) < 25 * min(seconds(500) for _ in range(2))
