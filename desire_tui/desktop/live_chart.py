"""A chart that follows the sliders, and takes clicks as places where orbits begin.

Only the newest values wait while one is drawn: a slider never has to catch up.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import DesireError

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.analysis.result import LiveChart
    from desire_tui.app import DesireApp
    from desire_tui.engine.graph.chart import Chart
    from desire_tui.engine.graph.model import Graph


class LivePage:
    """The page of the last analysis whose chart is live."""

    def __init__(self, app: DesireApp) -> None:
        self._app = app
        self._page: Graph | None = None
        self._live: LiveChart | None = None
        self._wanted: dict[str, float] | None = None
        self._starts: list[tuple[float, float]] = []
        self._is_drawing = False
        self.drawn = 0
        """How often it was drawn anew."""

    @property
    def is_shown(self) -> bool:
        """Whether the graph pane shows it."""
        return self._page is not None and self._app.graph.page is self._page

    def follow(self, page: Graph, live: LiveChart) -> None:
        """Draw this page anew from now on."""
        self._page, self._live = page, live
        self._wanted, self._starts = None, []

    def moved(self, values: dict[str, float]) -> None:
        """Show it with the sliders at these values."""
        self._wanted = values
        self._draw()

    def started(self, x: float, y: float) -> None:
        """Begin an orbit at a place of it."""
        self._starts.append((x, y))
        self._draw()

    def pointed(self, across: float, up: float) -> None:
        """Begin an orbit at a place given in parts of the page's frame, from the left and from below."""
        if self._page is not None:
            frame = self._page.frame
            x = frame.left + across * (frame.right - frame.left)
            self.started(x, frame.bottom + up * (frame.top - frame.bottom))

    def _draw(self) -> None:
        live = self._live
        if self._is_drawing or live is None:
            return
        work: Callable[[], Chart]
        if self._starts:
            x, y = self._starts.pop(0)

            def work() -> Chart:
                return live.started(x, y)
        elif self._wanted is not None:
            values, self._wanted = self._wanted, None

            def work() -> Chart:
                return live.moved(values)
        else:
            return
        self._is_drawing = True
        self._app.in_background(lambda: self._work(work))

    def _work(self, work: Callable[[], Chart]) -> None:
        chart, problem = None, None
        try:
            chart = work()
        except DesireError as error:
            problem = error
        finally:
            self._app.on_screen(self._show, chart, problem)

    def _show(self, chart: Chart | None, problem: DesireError | None) -> None:
        from desire_tui.engine.graph.chart_page import update_page

        self._is_drawing = False
        if problem is not None:
            self._app.show_problems(problem.diagnostics)
        if chart is not None and self._page is not None:
            update_page(self._page, chart)
            self.drawn += 1
            self._app.graph.tick()
        self._draw()
