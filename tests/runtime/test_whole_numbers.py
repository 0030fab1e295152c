"""The one conversion of a program's number to a whole one."""

from __future__ import annotations

import pytest

from desire_tui.engine.whole_numbers import WHOLE_MOST, whole


@pytest.mark.parametrize(
    "value", [-1e300, -WHOLE_MOST - 2.0, WHOLE_MOST + 2.0, 1e300, float("inf"), float("nan")]
)
def test_what_is_no_whole_number_of_the_range(value):
    assert whole(value) is None


def test_whole_numbers_are_truncated_and_kept_within_their_range():
    assert [whole(v, 0, 3) for v in (-1.0, -0.5, 0.5, 3.9, 4.0)] == [None, 0, 0, 3, None]
    assert whole(float(WHOLE_MOST)) == WHOLE_MOST
