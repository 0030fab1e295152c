"""Round numbers on axes."""

from __future__ import annotations

from math import inf, isfinite, nan

import pytest
from hypothesis import given
from hypothesis import strategies as st

from desire_tui.engine.graph.ticks import minor_ticks, round_ticks, rounded_limits, tick_labels


@pytest.mark.parametrize(
    ("low", "high", "labels"),
    [
        (-1, 1, "-1 -0.5 0 0.5 1"),
        (-2.5, 2.5, "-2 -1 0 1 2"),
        (0, 10, "0 2 4 6 8 10"),
        (0, 1e6, "0 2e5 4e5 6e5 8e5 1e6"),
        (1000.0001, 1000.0002, "1000.0001 1000.00012 1000.00014 1000.00016 1000.00018 1000.0002"),
        (0, 1e-9, "0 2e-10 4e-10 6e-10 8e-10 1e-9"),
        (0, 0.00033, "0 0.00005 0.0001 0.00015 0.0002 0.00025 0.0003"),
    ],
)
def test_five_to_seven_round_numbers(low, high, labels):
    assert " ".join(tick_labels(round_ticks(low, high))) == labels


@given(st.floats(-1e300, 1e300), st.floats(1e-300, 1e300), st.integers(1, 7))
def test_ticks_lie_inside_and_differ(low, width, most):
    high = low + width
    ticks = round_ticks(low, high, most)
    assert len(ticks) <= most
    assert all(low <= tick <= high for tick in ticks)
    if width > 1e-9 * abs(low):
        assert len(set(tick_labels(ticks))) == len(ticks)


@pytest.mark.parametrize(("low", "high"), [(nan, 1), (0, inf), (-1.7e308, 1.7e308), (1, 1), (1, 0)])
def test_limits_without_numbers_between_have_no_ticks(low, high):
    assert round_ticks(low, high) == ()


def test_minor_ticks_divide_the_steps():
    assert minor_ticks((0.0, 2.0, 4.0), 0, 5, 20) == (0.5, 1, 1.5, 2.5, 3, 3.5, 4.5, 5)
    assert minor_ticks((0.0, 1.0, 2.0), 0, 2, 4) == (0.5, 1.5)
    assert minor_ticks((0.0, 1.0, 2.0), 0, 2, 1) == ()


@pytest.mark.parametrize(
    ("low", "high", "limits"),
    [(0.3, 47, (0, 50)), (10, 12, (10, 12)), (-7, 0.1, (-8, 2)), (5, 5, (4.4, 5.6)), (0, 0, (-1, 1))],
)
def test_limits_are_round_and_begin_at_0_where_that_is_near(low, high, limits):
    assert rounded_limits(low, high) == pytest.approx(limits)


@given(st.floats(-1e308, 1e308), st.floats(-1e308, 1e308))
def test_limits_hold_what_they_are_made_for(a, b):
    low, high = min(a, b), max(a, b)
    if isfinite(high - low):
        bottom, top = rounded_limits(low, high)
        assert bottom <= low + 1e-5 * (top - bottom)
        assert top >= high - 1e-5 * (top - bottom)
