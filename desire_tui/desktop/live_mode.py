"""Live mode: a moved slider re-runs its program with the new value at once.

While a re-run goes on only the newest values wait for the next one: a slider never has to catch up. Sliders
show what the last run used: after F5 that is what the program's text says.
"""

from __future__ import annotations

from time import monotonic, perf_counter
from typing import TYPE_CHECKING

from desire_tui.actions.run_actions import source_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.app import DesireApp
    from desire_tui.editor.code_area import CodeArea
    from desire_tui.engine.graph.model import Graph
    from desire_tui.engine.session.parameters import Parameter
    from desire_tui.engine.source import Source, Span
    from desire_tui.panes.sliders import Sliders

GESTURE_S = 1.0
"""Moves of a slider that follow each other faster are one: the ghost is the curve from before them all."""


class LiveMode:
    """The sliders and the re-runs."""

    def __init__(self, app: DesireApp) -> None:
        self._app = app
        self._wanted: tuple[dict[str, float], bool] | None = None
        self._running = False
        self._is_live = False
        """Whether the last run was one of a slider's."""
        self._gesture: tuple[str, float] = ("", 0.0)
        self._ghost: Graph | None = None
        self.runs_made = 0
        self.seconds = 0.0
        """Real time the last re-run took."""

    # ------------------------------------------------------------------------------------------ the sliders

    @property
    def sliders(self) -> Sliders:
        """They stand below the graph."""
        return self._app.graph.sliders

    @property
    def _area(self) -> CodeArea:
        return self._app.editor.active or self._app.editor.front

    def _parameters(self) -> list[Parameter]:
        session = self._app.session
        if not session.runs or session.program is None:
            return []
        from desire_tui.engine.session.parameters import parameters

        return parameters(session.program, session.values, session.runs[-1].start)

    async def choose(self, name: str) -> None:
        """Give the named parameter a slider, or those chosen from a list."""
        app, found = self._app, self._parameters()
        if not found:
            app.notify("Sliders are for parameters of a program that has run: press F5 first.", timeout=3)
            return
        number = self._area.buffer.number
        if name:
            chosen = [one for one in found if name in (one.label, one.name)]
            if not chosen:
                app.notify(f"'{name}' is no parameter of the last run.", markup=False, timeout=3)
        else:
            from desire_tui.panes.parameter_list import ParameterList

            has = [slider.label for slider in self.sliders.of(number)]
            answer = await app.push_screen_wait(ParameterList(found, has))
            if answer is None:
                return
            chosen = answer
            self.sliders.keep(number, [one.name for one in chosen])
        for one in chosen:
            self.sliders.add(one.name, one.value, label=one.label, program=number)
        if chosen and "graph" not in app.main_screen.shown:
            app.main_screen.make_visible(app.graph)

    def agree(self) -> None:
        """Show the sliders of the active program, with the values of its last run."""
        app, sliders = self._app, self.sliders
        sliders.forget(area.buffer.number for area in app.editor.areas)
        sliders.show_program(self._area.buffer.number)
        if not sliders.shown:
            return
        values = {one.name: one.value for one in self._parameters()}
        for slider in sliders.shown:
            if slider.quantity in values:
                slider.agree(values[slider.quantity], is_own=not self._is_live)

    def write(self) -> None:
        """Write the values of the sliders into the program's text."""
        from desire_tui.engine.session.parameters import written_into
        from desire_tui.engine.syntax.parse import parse

        app, area = self._app, self._area
        sliders = self.sliders.of(area.buffer.number)
        values = {slider.quantity: slider.value for slider in sliders if slider.value != slider.start}
        if not values:
            app.notify("The sliders stand at the program's own values.", timeout=3)
            return
        source = source_of(area)
        edits, refused = written_into(parse(source), values)
        if edits:
            _replace(area, source, edits)
        for slider in sliders:
            if slider.quantity in values and slider.quantity not in refused:
                slider.agree(slider.value, is_own=True)
        done = [f"{name} = {value:.6g}" for name, value in values.items() if name not in refused]
        if done:
            app.notify(f"Written into {area.buffer.name}: {', '.join(done)}", markup=False, timeout=3)
        if refused:
            app.notify(
                f"Not written: {', '.join(refused)} gets its value in several places.",
                markup=False, severity="warning", timeout=4,
            )  # fmt: skip

    # ------------------------------------------------------------------------------------------- the re-runs

    def ask(self, values: dict[str, float], *, overlay: bool, quantity: str = "") -> None:
        """Re-run with these values as soon as the engine is free; `quantity` was moved."""
        now, (before, at) = monotonic(), self._gesture
        if quantity != before or now - at > GESTURE_S:
            self._ghost = self._app.graph.page
        self._gesture = quantity, now
        self._wanted = (values, overlay)
        if not self._app.engine.is_busy:
            self._start()
        elif not self._running:
            self._app.run_actions.end_now()

    def engine_idle(self) -> None:
        """Go on with the newest values."""
        self._is_live, self._running = self._running, False
        if self._wanted is not None and not self._app.engine.is_busy:
            self._start()
        else:
            self.agree()

    def _start(self) -> None:
        assert self._wanted is not None
        values, overlay = self._wanted
        self._wanted, self._running = None, True
        app, area = self._app, self._area
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
        app.graph.paging.ghost_next = None if overlay else self._ghost
        app.engine.submit(rerun)


def _replace(area: CodeArea, source: Source, edits: Sequence[tuple[Span, str]]) -> None:
    """Make edits, given from the last place to the first, in a tab's text; one undo takes all back."""
    first, last = edits[-1][0].start, edits[0][0].end
    text = source.text[first:last]
    for span, new in edits:
        text = text[: span.start - first] + new + text[span.end - first :]
    start, end = source.position(first), source.position(last)
    area.replace(text, (start.row - 1, start.column - 1), (end.row - 1, end.column - 1))
