"""How far a switch's argument is from where it switches."""

from __future__ import annotations

from math import floor, trunc

import pytest

from desire_tui.engine.integration.switching.margins import distance
from desire_tui.engine.lowered.switching import Threshold

_SIDES = {
    Threshold.ZERO: lambda x: x > 0,
    Threshold.UNIT: lambda x: (x > 1) - (x < -1),
    Threshold.HALF: lambda x: floor(abs(x) + 0.5) * (1 if x > 0 else -1),
    Threshold.WHOLE: trunc,
    Threshold.EVERY_WHOLE: floor,
}


@pytest.mark.parametrize("threshold", Threshold)
def test_nothing_switches_nearer_than_the_distance_and_something_just_beyond(threshold):
    side = _SIDES[threshold]
    for k in range(-350, 350):
        x = k / 100 + 0.0037
        room = distance(threshold, x)
        inner, outer = room * (1 - 1e-9), room * (1 + 1e-9)
        assert side(x - inner) == side(x) == side(x + inner)
        assert side(x - outer) != side(x) or side(x + outer) != side(x)
