"""The graph pane's actions, and files made from graphs."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from desire_tui.actions import Controller
from desire_tui.common.dialogs import LineDialog
from desire_tui.common.paths import full
from desire_tui.engine.atomic_file import replacing
from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.outputs.formats import CSV, PICTURES, PNG, endings
from desire_tui.engine.outputs.picture_options import name_and_options

if TYPE_CHECKING:
    from desire_tui.engine.session.quantity_plots import PlotOutcome

NOT_CHARTED: dict[PlotOutcome, str] = {
    "unknown": "'{name}' has no value: nothing to plot.",
    "array": "'{name}' is an array: plot it alone, or one of its elements: {name}[1]",
    "no run": "No run has recorded '{name}' yet: press F5.",
    "constant": "'{name}' is not changed by the run: its value is among the quantities (Alt+Q).",
    "changed": "The last run did not record '{name}' and cannot be repeated: add it to dispt, then press F5.",
    "failed": "The last run fails when repeated to record '{name}': add it to dispt, then press F5.",
}


class GraphActions(Controller):
    """Part `graph` of the command table."""

    def full(self, argument: str = "") -> None:
        """Show the graph alone, or all panes."""
        del argument
        self.app.toggle_maximized("graph")

    def zoom_in(self, argument: str = "") -> None:
        """Magnify."""
        del argument
        self.app.graph.zoom(0.5)

    def zoom_out(self, argument: str = "") -> None:
        """Show more."""
        del argument
        self.app.graph.zoom(2.0)

    def left(self, argument: str = "") -> None:
        """Pan."""
        del argument
        self.app.graph.pan(-0.2, 0.0)

    def right(self, argument: str = "") -> None:
        """Pan."""
        del argument
        self.app.graph.pan(0.2, 0.0)

    def up(self, argument: str = "") -> None:
        """Pan."""
        del argument
        self.app.graph.pan(0.0, 0.2)

    def down(self, argument: str = "") -> None:
        """Pan."""
        del argument
        self.app.graph.pan(0.0, -0.2)

    def fit(self, argument: str = "") -> None:
        """Show the scale that holds all curves."""
        del argument
        if self.app.graph.page is None:
            self.app.notify("No graph yet: press F5.", timeout=2)
        self.app.graph.fit_curves()

    def log(self, argument: str = "") -> None:
        """Make the ordinate logarithmic, then both axes, then neither; or as the argument says."""
        graph = self.app.graph
        if graph.page is None:
            self.app.notify("No graph yet: press F5.", timeout=2)
            return
        from desire_tui.engine.graph.axes import AXIS_WORDS  # with it NumPy, which a start does without

        axes = graph.page.axes
        word = f"log{argument}" if argument in ("x", "y") else argument
        if word not in AXIS_WORDS:
            word = "logy" if not axes.is_log else "loglog" if axes.log_y and not axes.log_x else "linear"
        graph.change_axes(word)
        told = {"logx": "abscissa", "logy": "ordinate", "loglog": "both axes"}.get(word)
        self.app.notify(f"Logarithmic: {told}." if told else "Linear axes.", timeout=2)

    def equal(self, argument: str = "") -> None:
        """Give both axes the same scale, or each its own again."""
        del argument
        page = self.app.graph.page
        if page is None:
            self.app.notify("No graph yet: press F5.", timeout=2)
            return
        self.app.graph.change_axes("equal" if not page.axes.equal else "unequal")

    def reset(self, argument: str = "") -> None:
        """Back to the program's scale."""
        del argument
        self.app.graph.reset_window()

    def read(self, argument: str = "") -> None:
        """Show or hide the cursor with the values of all curves."""
        del argument
        on = self.app.graph.toggle_readout()
        self.app.notify(
            "Read-out on: a cursor line with all values. ← → in the graph move it, Alt+R takes it away."
            if on
            else "Read-out off.",
            timeout=4,
        )

    def legend(self, argument: str = "") -> None:
        """Show or hide the colour keys."""
        del argument
        self.app.graph.toggle_keys()

    def older(self, argument: str = "") -> None:
        """Page back."""
        del argument
        self._turn(-1)

    def newer(self, argument: str = "") -> None:
        """Page forward."""
        del argument
        self._turn(1)

    def _turn(self, step: int) -> None:
        if not self.app.graph.turn(step):
            self.app.notify(
                "No further graph." if len(self.app.session.graphs) else "No graph yet.", timeout=2
            )

    async def snapshot(self, argument: str = "") -> None:
        """Save the graph shown as PNG, SVG or PDF."""
        app = self.app
        if app.graph.page is None:
            app.notify("No graph yet: press F5.", timeout=2)
            return
        name = argument
        if not name:
            stem = Path((app.editor.active or app.editor.front).buffer.name).stem
            typed = await app.push_screen_wait(
                LineDialog(
                    "Save the graph as",
                    f"{stem}{PNG.ending}",
                    f"the ending {endings(PICTURES)} chooses the kind; behind it, if you like, "
                    "size in inches, resolution and style: graph.png 6x4 300dpi paper (or screen)",
                )
            )
            if not typed:
                return
            name = typed
        try:
            name, options = name_and_options(name)
        except ValueError as error:
            app.report_error(
                f"no picture is made with {error}: sizes are like 6x4 (inches), 300dpi", code=None
            )
            return
        if (path := self._path(name, PNG.ending)) is None:
            return
        page = app.graph.page
        if not app.may_write(path, frozenset(known.ending for known in PICTURES)):
            return

        def write() -> None:
            try:
                written = app.session.snapshot(path, page, options)
            except DesireError as error:
                app.on_screen(app.show_problems, error.diagnostics)
            else:
                app.on_screen(app.snapshot_written, written)

        app.in_background(write)

    def _path(self, name: str, ending: str) -> Path | None:
        if not self.app.is_file_name(name):
            return None
        return full(Path(name) if Path(name).suffix else Path(f"{name}{ending}"), self.app.session.folder)

    async def picture(self, argument: str = "") -> None:
        """Show the graph as a picture; `s` there saves it."""
        del argument
        app = self.app
        if app.graph.page is None:
            app.notify("No graph yet: press F5.", timeout=2)
            return
        from desire_tui.panes.picture_view import PictureScreen

        if await app.push_screen_wait(PictureScreen(app.graph, app.in_background)):
            await self.snapshot()

    async def export(self, argument: str = "") -> None:
        """Save the samples of the last run as CSV."""
        app = self.app
        if not app.session.runs:
            app.notify("No run yet: press F5.", timeout=2)
            return
        ask = LineDialog("Save the samples as", f"samples{CSV.ending}")
        name = argument or await app.push_screen_wait(ask)
        if not name:
            return
        if (path := self._path(name, CSV.ending)) is None:
            return
        if not app.may_write(path, frozenset({CSV.ending})):
            return
        try:
            with replacing(path, make_folder=True) as file:
                app.write_samples(file)
        except OSError as error:
            app.report_error(f"cannot write {path}: {error.strerror}", code=106)
            return
        app.file_written(path)

    def chart(self, argument: str = "") -> None:
        """Plot quantities: those named, the one chosen among the quantities, or the editor's word."""
        app = self.app
        chosen = app.quantities.chosen if app.quantities.has_focus_within else None
        name = argument or (chosen.name if chosen is not None else app.editor.front.word_at_cursor())
        if not name:
            app.notify("Choose a quantity to plot, or type: graph x", timeout=3)
            return
        if app.engine.is_busy:
            app.notify(f"'{name}' is plotted when the run is over.", markup=False, timeout=2)

        def plot() -> None:
            became, what = app.session.plot_quantities(name)
            if became == "shown":
                app.on_screen(app.show_run)
            else:
                app.on_screen(app.notify, NOT_CHARTED[became].format(name=what), markup=False, timeout=4)

        app.engine.submit(plot)

    def overlay(self, argument: str = "") -> None:
        """Overlay an older graph (its number, default: the one before) on the one shown."""
        if not self.app.graph.overlay(int(argument) if argument.isdecimal() else None):
            self.app.notify("There is no such graph to overlay.", timeout=2)
