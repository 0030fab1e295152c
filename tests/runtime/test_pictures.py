"""What SHOW keeps of a run: bounded memory, the first picture and the last, between them every n-th."""

from __future__ import annotations

import numpy as np
import pytest

from desire_tui.engine.runtime import simulator
from tests.runtime.running import session_for

TEXT = "ARRAY A[3] | TMAX = {last} | NN = {points} | DT = 1 | irule 2\ndrun\nDYNAMIC\nd/dt x = 1\nVector A = x\nSHOW A\n"


def pictures(points):
    session = session_for(TEXT.format(last=points - 1, points=points))
    return [film[0][0] for film in session.runs[0].pictures]


def test_every_sample_is_kept_while_there_is_room(monkeypatch):
    monkeypatch.setattr(simulator, "PICTURES_BYTES_MAX", 5 * 3 * 8)
    assert pictures(5) == [0, 1, 2, 3, 4]


@pytest.mark.parametrize("points", [6, 7, 8, 9, 10, 11, 20, 41, 64])
def test_every_second_picture_goes_when_it_is_full(points, monkeypatch):
    monkeypatch.setattr(simulator, "PICTURES_BYTES_MAX", 5 * 3 * 8)
    kept = pictures(points)
    assert kept[0] == 0
    assert kept == sorted(set(kept))
    assert kept[-1] == points - 1
    apart = np.diff(kept)
    assert (apart[:-1] == apart[0]).all()
    assert apart[-1] <= apart[0]
    assert 3 <= len(kept) <= 5
    if points == 7:
        assert kept == [0, 2, 4, 6]


def test_of_pictures_larger_than_all_the_room_the_last_is_kept(monkeypatch):
    monkeypatch.setattr(simulator, "PICTURES_BYTES_MAX", 8)
    assert pictures(6) == [0, 5]
