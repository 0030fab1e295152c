"""A picture below a cell that grows with the runs."""

from __future__ import annotations

from base64 import b64encode
from time import monotonic
from typing import TYPE_CHECKING, Any

from desire_tui.engine.outputs.run_plot import run_png
from desire_tui.engine.outputs.sampled_run import curves_over_t

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from desire_tui.engine.outputs.run import Run

INTERVAL_SECONDS = 0.3
_SHARE = 4.0
"""Drawing may take one part in so many of the time."""
RUNS_MOST = 50
"""The newest, while more are made: a picture of thousands takes longer than the runs."""


class LiveGraph:
    """Shows runs in a display of its own and draws it anew now and then."""

    def __init__(self) -> None:
        self._display: Any = None
        self._next = monotonic() + INTERVAL_SECONDS

    def grow(self, runs: Callable[[], Sequence[Run]]) -> None:
        """Draw what there is, if it is time."""
        began = monotonic()
        if began >= self._next:
            self.draw(runs()[-RUNS_MOST:])
            self._next = monotonic() + max(INTERVAL_SECONDS, _SHARE * (monotonic() - began))

    def draw(self, runs: Sequence[Run], text: str = "") -> None:
        """Draw runs that have curves."""
        from IPython.display import display

        if not any(len(run.t) and curves_over_t(run) for run in runs):
            return
        picture = {
            "image/png": b64encode(run_png(runs)).decode("ascii"),
            "text/plain": text or repr(runs[-1]),
        }
        if self._display is None:
            self._display = display(picture, raw=True, display_id=True)
        else:
            self._display.update(picture, raw=True)
