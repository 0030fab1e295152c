"""Work that takes too long is broken off."""

from __future__ import annotations

import sys
import weakref
from time import monotonic

import pytest

from desire_tui.editor.time_limit import TookTooLong, at_most


def busy(seconds: float) -> None:
    until = monotonic() + seconds
    while monotonic() < until:
        pass


def test_an_alarm_that_python_drops_rings_again(monkeypatch: pytest.MonkeyPatch):
    dropped = []
    monkeypatch.setattr(sys, "unraisablehook", dropped.append)

    class Cleared:
        pass

    cleared = [Cleared()]
    reference = weakref.ref(cleared[0], lambda _: busy(60))

    def work() -> None:
        with at_most(0.02):
            cleared.clear()
            busy(60)

    with pytest.raises(TookTooLong):
        work()
    assert reference() is None
    assert [type(one.exc_value) for one in dropped] == [TookTooLong]
    busy(0.1)  # nothing rings any more
