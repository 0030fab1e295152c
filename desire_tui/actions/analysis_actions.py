"""Analyses on the desktop: what is asked of the front tab's program, and what is done with the answer."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from desire_tui.actions import Controller
from desire_tui.actions.run_actions import source_of
from desire_tui.analysis.registry import ANALYSES, BY_NAME
from desire_tui.common.dialogs import LineDialog
from desire_tui.common.paths import full
from desire_tui.engine.diagnostics import DesireError

if TYPE_CHECKING:
    from desire_tui.analysis.registry import Analysis
    from desire_tui.analysis.subject import Subject
    from desire_tui.app import DesireApp

NOTHING_FOUND = "Nothing was analysed yet: type for instance  spectrum x"
SAVED = frozenset({".csv", ".json", ".png", ".svg", ".pdf"})


class AnalysisActions(Controller):
    """Part `analysis` of the command table: a method for each analysis, by its name."""

    def __init__(self, app: DesireApp) -> None:
        super().__init__(app)
        self._typed: dict[str, str] = {}
        for analysis in ANALYSES:
            setattr(self, analysis.name, partial(self.start, analysis))

    async def start(self, analysis: Analysis, argument: str = "") -> None:
        """Begin an analysis of the front tab's program."""
        app = self.app
        if app.analyses.is_going:
            app.notify("An analysis goes on: Shift+F10 stops it.", timeout=3)
            return
        if not argument and not analysis.may_be_empty:
            asked = LineDialog(
                f"{analysis.title} of the front tab",
                self._typed.get(analysis.name, analysis.example),
                analysis.form,
            )
            argument = await app.push_screen_wait(asked) or ""
            if not argument:
                return
        self._typed[analysis.name] = argument
        app.analyses.begin(analysis, self._subject(), argument)

    def _subject(self) -> Subject:
        """Return the front tab's program with the values of its sliders, and where the states are."""
        from desire_tui.analysis.subject import Subject
        from desire_tui.engine.session.state_labels import state_labels
        from desire_tui.engine.values import T

        app = self.app
        area = app.editor.front
        sliders = app.live_mode.sliders.of(area.buffer.number)
        values = app.session.values
        here = {name: float(values.data[slot]) for slot, name in state_labels(values).items()}
        if here:
            here["t"] = values.cells[T]
        return Subject(
            source_of(area),
            settings={slider.quantity: slider.value for slider in sliders if slider.value != slider.start},
            here=here or None,
        )

    async def over(self, argument: str = "") -> None:
        """Follow steady states and cycles over the range of the slider in focus, or else the first one."""
        del argument
        app = self.app
        sliders = app.live_mode.sliders.shown
        slider = next((one for one in sliders if one.has_focus), sliders[0] if sliders else None)
        if slider is None:
            app.notify("No parameter has a slider: live gives it one.", timeout=3)
            return
        request = f"{slider.quantity} in [{slider.scale.low:.10g}, {slider.scale.high:.10g}]"
        await self.start(BY_NAME["continue"], request)

    async def orbit(self, argument: str = "") -> None:
        """Begin an orbit in the phase plane that is shown."""
        from desire_tui.analysis.request import Request

        app = self.app
        if not app.live_page.is_shown:
            app.notify("Orbits begin in a phase plane: type  phase", timeout=3)
            return
        told = "x and y, or click into the graph"
        asked = argument or await app.push_screen_wait(LineDialog("An orbit from", "0.5, 1", told))
        if not asked:
            return
        words = Request(asked, "orbit 0.5, 1")
        try:
            x = words.number("the abscissa")
            words.expect(",")
            y = words.number("the ordinate")
            words.end()
        except DesireError as error:
            app.show_problems(error.diagnostics)
        else:
            app.live_page.started(x, y)

    def stop(self, argument: str = "") -> None:
        """End the analysis."""
        del argument
        if self.app.analyses.is_going:
            self.app.analyses.stop()
        else:
            self.app.notify("No analysis goes on.", timeout=3)

    async def save(self, argument: str = "") -> None:
        """Write what the last analysis found."""
        app = self.app
        result, program = app.analyses.result, app.analyses.program
        if result is None:
            app.notify(NOTHING_FOUND, timeout=3)
            return
        told = "the ending .csv, .json, .png, .svg or .pdf chooses the kind"
        name = argument.strip("'\" ") or await app.push_screen_wait(
            LineDialog("Save the results as", "results.csv", told)
        )
        if not name or not app.is_file_name(name):
            return
        path = full(Path(name), app.session.folder)
        if not app.may_write(path, SAVED):
            return

        def write_results() -> None:
            from desire_tui.analysis.files import write

            try:
                write(result, path, program)
            except DesireError as error:
                app.on_screen(app.show_problems, error.diagnostics)
            else:
                app.on_screen(app.file_written, path)

        app.in_background(write_results)
