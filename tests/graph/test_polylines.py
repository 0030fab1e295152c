"""Clipping and thinning lose nothing that can be seen."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from desire_tui.engine.graph.polylines import clip_polyline, thin_columns

COORDINATES = st.floats(-3, 4, allow_nan=False) | st.sampled_from(
    [float("nan"), float("inf"), -float("inf"), 0.0, 1.0, 1e300]
)


def clipped(points):
    x, y = np.array(points, dtype=float).reshape(-1, 2).T
    return np.column_stack(clip_polyline(x, y))


def test_known_cuts():
    assert clipped([(-1, 0.5), (2, 0.5)]) == pytest.approx(np.array([[0, 0.5, 1, 0.5]]))
    assert clipped([(0.2, 0.2), (0.8, 0.6)]) == pytest.approx(np.array([[0.2, 0.2, 0.8, 0.6]]))
    assert clipped([(-0.5, 0), (0.5, 1)]) == pytest.approx(np.array([[0, 0.5, 0.5, 1]]))
    assert len(clipped([(-1, 2), (2, 3)])) == 0
    assert len(clipped([(-1, 0.5), (0.5, 3)])) == 0  # passes the corner outside
    assert len(clipped([(0.1, 0.1), (np.nan, 0.2), (0.3, 0.3)])) == 0
    assert len(clipped([(0.1, 0.1), (np.inf, 0.2)])) == 0


@given(st.lists(st.tuples(COORDINATES, COORDINATES), min_size=2, max_size=30))
def test_nothing_is_drawn_outside_and_pieces_lie_on_their_lines(points):
    with np.errstate(all="ignore"):
        pieces = clipped(points)
    assert np.isfinite(pieces).all()
    assert ((pieces >= -1e-9) & (pieces <= 1 + 1e-9)).all()


@given(
    st.lists(st.tuples(st.floats(-2, 3), st.floats(-2, 3)), min_size=2, max_size=12),
    st.lists(st.floats(0, 1), min_size=1, max_size=5),
)
def test_every_inner_point_of_the_polyline_is_kept(points, parts):
    """Against sampling: a point of the line inside the frame lies on one of the pieces."""
    pieces = clipped(points)
    for (xa, ya), (xb, yb) in pairwise(points):
        for part in parts:
            x, y = xa + part * (xb - xa), ya + part * (yb - ya)
            if 0.001 < x < 0.999 and 0.001 < y < 0.999:
                assert min(distance(piece, x, y) for piece in pieces) < 1e-6


def distance(piece, x, y):
    x1, y1, x2, y2 = piece
    length = (x2 - x1) ** 2 + (y2 - y1) ** 2
    s = 0.0 if length == 0 else min(max(((x - x1) * (x2 - x1) + (y - y1) * (y2 - y1)) / length, 0), 1)
    return float(np.hypot(x1 + s * (x2 - x1) - x, y1 + s * (y2 - y1) - y))


@given(st.integers(1, 40), st.integers(0, 2**32 - 1), st.integers(1, 2000))
def test_thinning_keeps_each_columns_extremes(columns, seed, count):
    random = np.random.default_rng(seed)
    x = np.sort(random.uniform(0, 1, count))
    y = random.normal(size=count)
    y[random.uniform(size=count) < 0.02] = np.nan
    thin_x, thin_y = thin_columns(x, y, columns)
    assert len(thin_x) <= count
    for column in range(columns):
        full = y[np.floor(x * columns) == column]
        kept = thin_y[np.floor(thin_x * columns) == column]
        if np.isfinite(full).any():
            assert np.nanmax(kept) == np.nanmax(full)
            assert np.nanmin(kept) == np.nanmin(full)


def test_thinning_is_short_for_long_curves():
    x = np.linspace(0, 1, 1_000_000)
    thin_x, thin_y = thin_columns(x, np.sin(1000 * x), 160)
    assert len(thin_x) <= 4 * 162
    assert thin_y.max() == pytest.approx(1.0, abs=1e-6)


def test_a_single_spike_survives():
    y = np.zeros(100_000)
    y[54_321] = 1.0
    assert thin_columns(np.linspace(0, 1, 100_000), y, 100)[1].max() == 1.0
