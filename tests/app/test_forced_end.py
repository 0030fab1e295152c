"""The time that a process asked to end from outside is left."""

from __future__ import annotations

from unittest.mock import patch

from desire_tui.desktop import forced_end
from desire_tui.desktop.forced_end import KEEPING_S, ORDERLY_S


def test_the_short_time_begins_only_once_the_work_is_kept():
    left: list[float] = [KEEPING_S]
    with patch.object(forced_end, "_exit_in", left.append), patch.object(forced_end, "end_all"):
        forced_end._end(lambda: 1 / 0)  # the main thread is at the same text and has to keep it
        assert left[-1] == KEEPING_S
        forced_end._end(lambda: None)
        assert left[-1] == ORDERLY_S
