"""Bands that are wider on one side, and patterns that are no band although they are narrow."""

from __future__ import annotations

import numpy as np

from desire_tui.engine.integration.pattern import Pattern
from desire_tui.engine.integration.plan import plan


def diagonals(n, *places):
    """A pattern with the main diagonal and others: row - column is one of `places`."""
    found = [(column + place, column) for place in places for column in range(n) if 0 <= column + place < n]
    rows, columns = np.array(found, dtype=np.int32).T
    return Pattern.of(n, rows, columns)


def test_a_band_below_the_diagonal_only():
    pattern = diagonals(1000, 1, 2)
    linear = plan(14, pattern).linear
    assert (linear.kind, linear.lower, linear.upper) == ("band", 2, 0)
    linear = plan(14, diagonals(1000, -1, 3)).linear
    assert (linear.kind, linear.lower, linear.upper) == ("band", 3, 1)


def test_two_diagonals_far_apart_need_two_colours():
    """As a full band they would take eleven."""
    assert diagonals(100, 10).colours.max() == 1
    assert diagonals(100, 9).colours.max() == 1
