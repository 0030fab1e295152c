"""Designs: any stretch of runs can be made alone; distributions come out as they should."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from desire_tui.studies.design import METHODS, Design
from desire_tui.studies.design_forms import over_texts, sample_texts
from desire_tui.studies.plan import boxes
from desire_tui.studies.streams import stream, streams


@cache
def six():
    return sample_texts(
        ["a=uniform(0,1), b=uniform(0,1), c=normal(3,2), d=uniform(0,1), e=uniform(0,1), f=randint(1,7)"]
    )


def test_a_grid_counts_its_last_quantity_first():
    design = Design(over_texts(["a=1,2", "b=5,6,7"]))
    assert design.shape == (2, 3)
    assert design.rows(0, 6).tolist() == [[1, 5], [1, 6], [1, 7], [2, 5], [2, 6], [2, 7]]
    assert design.rows(4, 1).tolist() == [[2, 6]]


@pytest.mark.parametrize("method", METHODS)
def test_runs_depend_on_seed_and_number_alone(method):
    design = Design(over_texts(["g=1,2"]), six(), runs=100, method=method, seed=7)
    rows = design.rows(0, 200)
    for first, count in ((0, 1), (95, 10), (199, 1), (3, 150)):
        again = Design(over_texts(["g=1,2"]), six(), runs=100, method=method, seed=7)
        assert np.array_equal(again.rows(first, count), rows[first : first + count])
    assert np.array_equal(rows[:100, 1:], rows[100:, 1:]), "the same draws at each point of the grid"
    other = Design({}, six(), runs=100, method=method, seed=8)
    assert not np.array_equal(other.rows(0, 100), rows[:100, 1:])
    if method == "random":  # so that a study can be made larger
        assert np.array_equal(Design({}, six(), runs=1000, seed=7).rows(0, 100), rows[:100, 1:])


def test_what_is_drawn_has_its_distribution():
    from scipy import stats

    random = Design({}, six(), runs=20_000, seed=1).rows(0, 20_000)
    for column, law in ((0, stats.uniform()), (2, stats.norm(3, 2))):
        assert stats.kstest(random[:, column], law.cdf).pvalue > 1e-3
    assert np.abs(np.corrcoef(random.T) - np.eye(6)).max() < 0.03
    latin = Design({}, six(), runs=500, method="latin").rows(0, 500)
    assert np.array_equal(np.sort((latin[:, 0] * 500).astype(int)), np.arange(500)), "one in each stratum"
    sobol = Design({}, six(), runs=512, method="sobol").rows(0, 512)
    assert np.array_equal(np.sort((sobol[:, 1] * 512).astype(int)), np.arange(512))


def test_streams_of_random_numbers_differ():
    states = {stream(99, number) for number in range(10_000)} | {
        stream(100, number) for number in range(10_000)
    }
    assert len(states) == 20_000
    assert stream(99, 0) == 99, "run 0 is the program"
    assert all(0 <= state < 1 << 48 for state in states)


@pytest.mark.parametrize(("state", "first"), [(99, 0), (2**48 - 1, 1), (5, 10**12)])
def test_streams_of_many_runs_are_those_of_each(state, first):
    assert streams(state, first, 50).tolist() == [stream(state, first + k) for k in range(50)]


def test_boxes_cover_neighbouring_runs():
    shape = (3, 4, 5)
    for first, count in ((0, 60), (7, 1), (7, 31), (19, 21), (20, 20), (59, 1)):
        marks = np.zeros(shape, dtype=int)
        order = []
        for box in boxes(first, count, shape):
            marks[box] += 1
            order.extend(np.arange(60).reshape(shape)[box].reshape(-1).tolist())
        assert order == list(range(first, first + count))
        assert marks.sum() == count
