"""An analysis on the desktop: made in a thread of its own; what it finds meanwhile is shown at once."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import DesireError
from desire_tui.panes.work_row import analysis_text

if TYPE_CHECKING:
    from textual.timer import Timer

    from desire_tui.analysis.registry import Analysis
    from desire_tui.analysis.result import Result
    from desire_tui.analysis.subject import Subject
    from desire_tui.app import DesireApp
    from desire_tui.engine.graph.model import Graph

LOOK_S = 0.1


class AnalysisRunner:
    """One analysis at a time; what the last one found stays until another begins."""

    def __init__(self, app: DesireApp) -> None:
        self._app = app
        self.result: Result | None = None
        self.program = ""
        self.is_going = False
        self._title = self._asked = ""
        self._is_ended_by_user = False
        self._told: tuple[float | None, str] = (None, "")
        self._so_far: Result | None = None
        """What is to be shown next."""
        self._pages: list[Graph] = []
        self._timer: Timer | None = None

    # ------------------------------------------------------------------------------ on the app's thread

    def begin(self, analysis: Analysis, subject: Subject, request: str) -> None:
        """Analyse a program."""
        self.is_going, self._is_ended_by_user = True, False
        self.result, self._so_far, self._pages, self._told = None, None, [], (None, "")
        self.program, self._title = subject.name, analysis.title
        self._asked = f"{analysis.name} {request}".rstrip()
        self._timer = self._app.main_screen.set_interval(LOOK_S, self._look)
        self._app.in_background(lambda: self._work(analysis, subject, request))

    def stop(self) -> None:
        """End it; what it found stays."""
        self._is_ended_by_user = True

    def _look(self) -> None:
        """Show what is new."""
        found, self._so_far = self._so_far, None
        if found is not None:
            self._show(found)
        self._app.graph.work_row.show(analysis_text(self.program, self._title, *self._told))

    def _show(self, found: Result) -> None:
        from desire_tui.engine.graph.chart_page import begin_page, update_page

        graph = self._app.graph
        charts = found.charts
        for page, chart in zip(self._pages, charts, strict=False):
            update_page(page, chart)
        for chart in reversed(charts[len(self._pages) :]):  # the first one's page is the newest
            page = begin_page(self._app.session.graphs, chart, self.program)
            self._pages.insert(0, page)
        if charts:
            graph.follow_newest(self._pages[0])
            self._app.show_run()
            graph.tick()

    def _ended(self, found: Result | None, problem: DesireError | None) -> None:
        self.is_going = False
        app = self._app
        if self._timer is not None:
            self._timer.stop()
            self._timer = None
        app.graph.work_row.hide()
        if problem is not None:
            app.show_problems(problem.diagnostics)
            return
        self.result = found
        if found is not None:
            self._show(found)
            if found.live is not None and self._pages:
                self._app.live_page.follow(self._pages[0], found.live)
            text = "\n".join(found.lines())
            app.command.console.add(text, "output")
            page = self._pages[0] if self._pages else None
            app.engine.submit(partial(app.session.note_result, self._asked, f"{text}\n", page))

    # ----------------------------------------------------------------------------- on the analysis's thread

    def _work(self, analysis: Analysis, subject: Subject, request: str) -> None:
        found, problem = None, None
        try:
            found = analysis.run(subject, request, self._heard)
        except DesireError as error:
            problem = error
        finally:
            self._app.on_screen(self._ended, found, problem)

    def _heard(self, part: float | None, told: str, so_far: Result | None = None) -> bool:
        self._told = (part, told)
        if so_far is not None:
            self._so_far = so_far
        return not self._is_ended_by_user
