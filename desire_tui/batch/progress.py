"""A line on the terminal that shows how far a run is, if it takes a while."""

from __future__ import annotations

from time import monotonic
from typing import IO, TYPE_CHECKING

from desire_tui.engine.session.status import State

if TYPE_CHECKING:
    from desire_tui.engine.session.session import Session

_SHOW_AFTER_SECONDS = 0.5
_BAR = 20


class Progress:
    """Call it now and then, and `clear` before anything else is written to the terminal."""

    def __init__(self, session: Session, terminal: IO[str]) -> None:
        self._session, self._terminal = session, terminal
        self._began = monotonic()
        self._shown = False

    def __call__(self) -> None:
        """Redraw the line."""
        status = self._session.status
        if monotonic() - self._began < _SHOW_AFTER_SECONDS or status.state is not State.RUNNING:
            return
        full = round(_BAR * status.progress)
        self._terminal.write(
            f"\r\x1b[Krun {status.run_text} {'━' * full}{'╌' * (_BAR - full)} t {status.t:.4g} / "
            f"{status.t0 + status.t_max:.4g} · {short(status.steps_per_second)} steps/s"
        )
        self._terminal.flush()
        self._shown = True

    def clear(self) -> None:
        """Remove the line."""
        if self._shown:
            self._terminal.write("\r\x1b[K")
            self._terminal.flush()
            self._shown = False


def short(number: float) -> str:
    """Return a number with three digits and k, M, G: `2.13 M`."""
    for factor, letter in ((1e9, " G"), (1e6, " M"), (1e3, " k")):
        if number >= factor:
            return f"{number / factor:.3g}{letter}"
    return f"{number:.3g}"
