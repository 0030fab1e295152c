"""Live mode: a moved slider re-runs the program with its value at once.

While a re-run goes on only the newest values wait for the next one: a slider never has to catch up.
"""

from __future__ import annotations

from time import perf_counter
from typing import TYPE_CHECKING

from desire_tui.actions.run_actions import source_of

if TYPE_CHECKING:
    from desire_tui.app import DesireApp


class LiveMode:
    """The re-runs."""

    def __init__(self, app: DesireApp) -> None:
        self._app = app
        self._wanted: tuple[dict[str, float], bool] | None = None
        self._running = False
        self.runs_made = 0
        self.seconds = 0.0
        """Real time the last re-run took."""

    def ask(self, values: dict[str, float], *, overlay: bool) -> None:
        """Re-run with these values as soon as the engine is free."""
        self._wanted = (values, overlay)
        if not self._app.engine.is_busy:
            self._start()
        elif not self._running:
            self._app.run_actions.end_now()

    def engine_idle(self) -> None:
        """Go on with the newest values."""
        self._running = False
        if self._wanted is not None and not self._app.engine.is_busy:
            self._start()

    def _start(self) -> None:
        assert self._wanted is not None
        values, overlay = self._wanted
        self._wanted, self._running = None, True
        app = self._app
        area = app.editor.active or app.editor.front
        app.editor.accept(area)
        source = source_of(area)

        def rerun() -> None:
            began = perf_counter()
            session = app.session
            app.send_breakpoints()
            session.override(values)
            try:
                session.erun(source)
            finally:
                session.override({})
                self.runs_made += 1
                self.seconds = perf_counter() - began

        app.graph.paging.overlay_next = overlay
        app.engine.submit(rerun)
