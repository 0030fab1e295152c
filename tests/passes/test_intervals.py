"""Intervals behave as the sets of numbers they stand for."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from desire_tui.engine.passes.intervals import Intervals

pieces = st.lists(st.tuples(st.integers(0, 40), st.integers(1, 9)), max_size=8)


def both(parts):
    made, plain = Intervals(), set()
    for slot, count in parts:
        made.add(slot, count)
        plain.update(range(slot, slot + count))
    return made, plain


@given(pieces, pieces, st.integers(0, 50), st.integers(1, 9))
def test_same_as_a_set(first, second, slot, count):
    made, plain = both(first)
    asked = set(range(slot, slot + count))
    assert made.covers(slot, count) == (asked <= plain)
    assert made.touches(slot, count) == bool(asked & plain)
    other, others = both(second)
    common = made.common(other)
    assert {s for a, b in zip(common.starts, common.ends, strict=True) for s in range(a, b)} == plain & others
    assert sorted(made.starts) == made.starts
    assert all(a < b for a, b in zip(made.ends, made.starts[1:], strict=False))
