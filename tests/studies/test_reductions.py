"""From samples to what is kept, against figures made by hand."""

from __future__ import annotations

import numpy as np
import pytest

from desire_tui.studies.keep import kept
from desire_tui.studies.reductions import reduce

KEEP = "max(y), min(y), mean(y), integral(y), first(y), y[end], t[y>2], y@(0, 0.25, 0.5, 9), y@1, std(y)"


def made(t, *columns, counts=None):
    items = kept(KEEP).items
    t, y = np.array(t, dtype=float).T, np.array(columns, dtype=float).T
    values = [(y > 2).astype(float) if item.kind == "when" else y for item in items]
    return reduce(items, t, values, np.array(counts or [len(t)] * t.shape[1]))


def test_of_one_run():
    t, y = [0, 0.5, 1.0, 2.0], [1.0, 3.0, -2.0, 4.0]
    expected = [4, -2, 1.5, 1.0 + 0.25 + 1.0, 1, 4, 0.5, 1, 2, 3, np.nan, -2, 5.25**0.5]
    assert made([t], y)[0] == pytest.approx(expected, nan_ok=True)


def test_of_runs_that_end_at_different_times():
    """What stands behind a run's end counts for nothing, whatever it is."""
    t = [[0, 1, 2, 3], [0, 1, np.nan, 7]]
    found = made(t, [1, 2, 3, 4], [5, 1, np.nan, np.inf], counts=[4, 2])
    alone = made([[0, 1, 2, 3]], [1, 2, 3, 4]), made([[0, 1]], [5, 1])
    assert np.array_equal(found, np.concatenate(alone), equal_nan=True)
    assert found[1, 3] == 3.0
    assert np.isnan(made([[0, 1]], [0, 1])[0, 6]), "a condition that never held"


def test_many_runs_give_the_bits_of_each_alone():
    random = np.random.default_rng(1)
    t = np.broadcast_to(np.linspace(0, 3, 501), (40, 501))
    y = random.normal(size=(40, 501))
    together = made(t, *y)
    for run in range(40):
        assert np.array_equal(made(t[:1], y[run])[0], together[run], equal_nan=True)


def test_backward_and_a_single_sample():
    assert made([[0, -1, -2]], [0, 1, 2])[0][3] == pytest.approx(-2)
    items = kept("y@(-0.5, -2), integral(y)").items
    t, y = np.array([[0.0], [-1.0], [-2.0]]), np.array([[0.0], [1.0], [2.0]])
    assert reduce(items, t, [y, y], np.array([3]))[0].tolist() == [0.5, 2, -2]
    assert reduce(items, t[:1], [y[:1], y[:1]], np.array([1]))[0].tolist()[2] == 0


@pytest.mark.filterwarnings("error")
def test_a_run_that_leaves_all_numbers_is_kept_without_a_word():
    t, y = [0.0, 1.0, 2.0], [1e308, 1.5e308, np.inf]
    found = made([t], y)[0]
    assert found[0] == found[2] == found[3] == np.inf
    assert found[1] == found[4] == 1e308


def test_the_standard_deviation_of_numbers_far_from_0():
    """The mean is taken off before squares are: of (1e9 + 1 … 1e9 + 3) it is that of (1, 2, 3)."""
    items = kept("std(y)").items
    t, y = (
        np.arange(4.0)[:, None].repeat(2, axis=1),
        1e9 + np.array([[1, 1], [2, 3], [3, np.nan], [2, np.inf]]),
    )
    assert reduce(items, t, [y], np.array([4, 2]))[:, 0].tolist() == [0.5**0.5, 1.0]
