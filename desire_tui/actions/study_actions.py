"""Studies on the desktop: the front tab's program for many values, its charts, its results as a file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from desire_tui.actions import Controller
from desire_tui.actions.run_actions import source_of
from desire_tui.common.dialogs import LineDialog
from desire_tui.common.paths import full
from desire_tui.engine.diagnostics import DesireError, closest

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.studies.charts import ChartKind
    from desire_tui.studies.dataset import Layout
    from desire_tui.studies.study import Study

EXAMPLE = "--over k=1:10:10 --keep x[end]"
HINT = "--over name=from:to:count --sample name=normal(4,0.5) --runs 1000 --keep x[end], max(v), x@0:2:0.1"
SAVED = frozenset({".nc", ".csv", ".zarr"})
NO_STUDY = f"There is no study. Type: study {EXAMPLE}"


class StudyActions(Controller):
    """Part `study` of the command table."""

    _typed = EXAMPLE

    async def start(self, argument: str = "") -> None:
        """Begin a study of the front tab's program, or tell the one that goes on what to do."""
        app = self.app
        word, _, rest = argument.partition(" ")
        match word:
            case "pause":
                return self._when_going(app.studies.pause)
            case "go":
                return self._when_going(app.studies.go_on)
            case "stop":
                return self.stop()
            case "chart":
                return await self.chart(rest)
            case "save":
                return await self.save(rest)
        if app.studies.is_going:
            app.notify("A study goes on: study stop ends it, study pause halts it.", timeout=3)
            return None
        if not argument:
            argument = (
                await app.push_screen_wait(LineDialog("Study of the front tab", self._typed, HINT)) or ""
            )
            if not argument:
                return None
        self._typed = argument
        from desire_tui.studies.typed_options import typed_options

        try:
            options = typed_options(argument)
            output = self._output(options["output"])
        except DesireError as error:
            app.show_problems(error.diagnostics)
            app.errors_reported += 1
            return None
        if options["points"] is not None:
            options["points"] = str(full(Path(options["points"]), app.session.folder))
            if not app.may_read(Path(options["points"])):
                return None
        if output is None and options["output"]:
            return None
        app.studies.begin(source_of(app.editor.front), options, output)
        return None

    def _output(self, name: str | None) -> Path | None:
        """Return where results go, None if nowhere or if that is not allowed. DesireError: no format."""
        if not name or not self.app.is_file_name(name):
            return None
        from desire_tui.studies.output import check_ending

        path = full(Path(name), self.app.session.folder)
        check_ending(path)
        return path if self.app.may_write(path, SAVED) else None

    def _made(self) -> Study | None:
        """Return the study there is; the user is told if there is none."""
        study = self.app.studies.study
        if study is None:
            self.app.notify(NO_STUDY, timeout=3)
        return study

    def pause(self, argument: str = "") -> None:
        """Make no new runs, or go on."""
        del argument
        studies = self.app.studies
        self._when_going(studies.go_on if studies.is_paused else studies.pause)

    def stop(self, argument: str = "") -> None:
        """End the study."""
        del argument
        self._when_going(self.app.studies.stop)

    def _when_going(self, act: Callable[[], object]) -> None:
        """Tell a study that goes on what to do; the user is told if none does."""
        if self.app.studies.is_going:
            act()
        else:
            self.app.notify(NO_STUDY if self.app.studies.study is None else "No study goes on.", timeout=3)

    async def chart(self, argument: str = "") -> None:
        """Show another chart: `histogram x[end]`, `scatter x[end] k`."""
        from desire_tui.studies.charts import CHART_KINDS

        app = self.app
        study = self._made()
        if study is None:
            return
        from desire_tui.studies.dataset import layouts

        known = layouts(study.plan)
        names = ", ".join(one.name for one in known)
        if not argument:
            told = f"{', '.join(CHART_KINDS)}; of {names}; scatter also over what: scatter {known[0].name} k"
            argument = (
                await app.push_screen_wait(LineDialog("Chart", f"histogram {known[0].name}", told)) or ""
            )
            if not argument:
                return
        word, _, rest = argument.partition(" ")
        kind = next((one for one in CHART_KINDS if one == word), None)
        if kind is None:
            near = closest(word, CHART_KINDS)
            told = f"did you mean {near}?" if near else f"there are {', '.join(CHART_KINDS)}"
            app.report_error(f"'{word}' is no chart: {told}", code=None)
            return
        self._add(kind, rest.strip(), known)

    def _add(self, kind: ChartKind, wanted: str, known: list[Layout]) -> None:
        layout = next((one for one in known if wanted == one.name or wanted.startswith(f"{one.name} ")), None)
        if layout is None and wanted:
            names = ", ".join(one.name for one in known)
            self.app.report_error(f"'{wanted}' is not kept by this study: {names}", code=None)
            return
        layout = layout or known[0]
        from desire_tui.studies.chart_page import StudyChart

        parameter = wanted.removeprefix(layout.name).strip()
        if why := self.app.studies.add(StudyChart(layout, kind, parameter)):
            self.app.report_error(why, code=None)

    async def save(self, argument: str = "") -> None:
        """Write the results so far as NetCDF, CSV or Zarr."""
        app = self.app
        study = self._made()
        if study is None:
            return
        told = "the ending .nc, .csv or .zarr chooses the kind"
        name = argument.strip("'\" ") or await app.push_screen_wait(
            LineDialog("Save the study as", "study.nc", told)
        )
        if not name:
            return
        try:
            path = self._output(name)
        except DesireError as error:
            app.show_problems(error.diagnostics)
            return
        if path is None:
            return

        def write_results() -> None:
            from desire_tui.studies.output import write

            try:
                write(study.result(), path)
            except DesireError as error:
                app.on_screen(app.show_problems, error.diagnostics)
            else:
                app.on_screen(app.file_written, path)

        app.in_background(write_results)
