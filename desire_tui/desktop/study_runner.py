"""A study on the desktop: made in threads of its own while programs are edited and run; its charts grow.

The study's thread computes charts; the app's thread looks for new ones a few times a second and shows them.
"""

from __future__ import annotations

from threading import Event
from time import monotonic
from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import DesireError
from desire_tui.panes.work_row import study_text

if TYPE_CHECKING:
    from pathlib import Path
    from typing import Any

    from textual.timer import Timer

    from desire_tui.app import DesireApp
    from desire_tui.engine.source import Source
    from desire_tui.studies.chart_page import StudyChart
    from desire_tui.studies.charts import Chart
    from desire_tui.studies.study import Progress, Study

LOOK_S = 0.1
CHART_S = 0.25
CHART_SHARE = 0.2
"""Charts are computed anew in at most so much of a study's time."""
CHARTS_MOST = 6


class StudyRunner:
    """The desktop's study: one at a time; the last one stays until another is planned."""

    def __init__(self, app: DesireApp) -> None:
        self._app = app
        self.study: Study | None = None
        self.charts: list[StudyChart] = []
        self.progress: Progress | None = None
        self.program = ""
        self._earlier = self._own()
        self.is_going = False
        self._is_ended_by_user = False
        self._may_go_on = Event()
        self._timer: Timer | None = None
        self._next_charts = 0.0

    @property
    def is_paused(self) -> bool:
        """Whether it goes on only when it is told to."""
        return self.is_going and not self._may_go_on.is_set()

    def _own(self) -> tuple[Study | None, list[StudyChart], Progress | None, str]:
        return self.study, self.charts, self.progress, self.program

    # ------------------------------------------------------------------------------ on the app's thread

    def begin(self, source: Source, options: dict[str, Any], output: Path | None) -> None:
        """Plan a study of a program and make its runs."""
        self.is_going, self._is_ended_by_user = True, False
        self._earlier = self._own()
        self.study, self.charts, self.progress = None, [], None
        self.program = source.file_name
        self._may_go_on.set()
        self._timer = self._app.main_screen.set_interval(LOOK_S, self._look)
        self._app.in_background(lambda: self._make(source, options, output))
        self._look()

    def pause(self) -> None:
        """Make no new runs; those under way are ended."""
        self._may_go_on.clear()
        self._look()

    def go_on(self) -> None:
        """Make runs again."""
        self._may_go_on.set()
        self._look()

    def stop(self) -> None:
        """End it; what was made stays."""
        self._is_ended_by_user = True
        self._may_go_on.set()

    def add(self, wanted: StudyChart) -> str:
        """Show another chart; return why there is none, or nothing."""
        drawn = self._drawn(wanted)
        if isinstance(drawn, str):
            return drawn
        wanted.drawn = drawn
        self.charts.append(wanted)
        self._show_charts()
        return ""

    def _look(self) -> None:
        """Show what is new."""
        self._show_charts()
        self._app.graph.work_row.show(study_text(self.program, self.progress, paused=self.is_paused))
        if not self.is_going:
            if self._timer is not None:
                self._timer.stop()
                self._timer = None
            self._app.graph.work_row.hide()

    def _show_charts(self) -> None:
        from desire_tui.studies.chart_page import begin_page, update_page

        for one in reversed(self.charts):  # the first quantity's page is the newest
            drawn, one.drawn = one.drawn, None
            if drawn is None:
                continue
            if one.page is None:
                one.page = begin_page(self._app.session.graphs, drawn, self.program)
                self._app.graph.follow_newest(one.page)
                self._app.show_run()
            else:
                update_page(one.page, drawn)
            self._app.graph.tick()

    def _ended(self, problem: DesireError | None) -> None:
        self.is_going = False
        self._look()
        app, study = self._app, self.study
        if problem is not None:
            app.show_problems(problem.diagnostics)
        if study is None:  # refused: the earlier one can still be asked for charts
            self.study, self.charts, self.progress, self.program = self._earlier
            return
        made = self.progress.made if self.progress is not None else 0
        told = f"Study of {self.program}: {made:,} of {study.plan.runs:,} runs"
        lines = [f"{told}, {study.store.failures.count} failed", *study.store.failures.lines()]
        app.command.console.add("\n".join(lines), "output")

    # --------------------------------------------------------------------------- on the study's thread

    def _make(self, source: Source, options: dict[str, Any], output: Path | None) -> None:
        problem = None
        try:
            from desire_tui.studies.chart_page import StudyChart
            from desire_tui.studies.charts import usual_kind
            from desire_tui.studies.command import planned
            from desire_tui.studies.dataset import layouts
            from desire_tui.studies.output import write

            study = planned(source, options)
            plan = study.plan
            if output is not None:
                plan.check_disk(output)
            charts = [StudyChart(one, usual_kind(plan, one)) for one in layouts(plan)[:CHARTS_MOST]]
            self.study, self.charts = study, charts
            study.run(options.get("threads"), progress=self._made)
            self._compute_charts()
            if output is not None and self.progress is not None:
                write(study.result(), output)
        except DesireError as error:
            problem = error
        finally:
            self._app.on_screen(self._ended, problem)

    def _made(self, progress: Progress) -> bool:
        self.progress = progress
        now = monotonic()
        if now >= self._next_charts:
            self._compute_charts()
            self._next_charts = monotonic() + max(CHART_S, (monotonic() - now) / CHART_SHARE)
        self._may_go_on.wait()
        return not self._is_ended_by_user

    def _compute_charts(self) -> None:
        for one in list(self.charts):
            drawn = self._drawn(one)
            if not isinstance(drawn, str):
                one.drawn = drawn

    def _drawn(self, one: StudyChart) -> Chart | str:
        from desire_tui.studies.charts import Results, chart
        from desire_tui.studies.stores import MemoryStore

        study = self.study
        assert study is not None
        assert isinstance(study.store, MemoryStore)
        return chart(
            Results(study.plan, one.layout, study.store.numbers(one.layout)), one.kind, one.parameter
        )
