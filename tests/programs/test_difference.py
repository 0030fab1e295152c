"""The measure by which two back ends are compared."""

from __future__ import annotations

import math

import pytest

from tests.programs.checking import difference

NAN, INF = math.nan, math.inf


@pytest.mark.parametrize(
    ("a", "b", "expected"),
    [
        ([], [], 0),
        ([1, 2], [1, 2, 3], INF),
        ([1, -4], [1.5, -4], 0.125),
        ([1, NAN, INF], [1, NAN, INF], 0),
        ([1, 4, NAN], [1.5, 4, NAN], 0.125),
        ([1, 4, INF], [1.5, 4, INF], 0.125),
        ([1, 4], [NAN, 4], INF),
        ([1, INF], [1, -INF], INF),
        ([1, 2], [1, INF], INF),
    ],
)
def test_difference(a, b, expected):
    assert difference(a, b) == expected
