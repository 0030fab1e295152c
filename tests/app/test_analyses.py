"""Analyses on the desktop: asked by a line, shown as pages and text, stopped, saved."""

from __future__ import annotations

from threading import Event

from desire_tui.actions.analysis_actions import NOTHING_FOUND
from desire_tui.analysis.registry import BY_NAME, Analysis
from desire_tui.analysis.result import Result
from desire_tui.commands import parse_line

from .conftest import desktop

TONE = """w = 3 | TMAX = 100 | DT = 0.01 | NN = 1001
drun
DYNAMIC
y = sin(w*t)
dispt y
"""


async def over(desk):
    await desk.until(lambda: not desk.app.analyses.is_going)


async def test_from_a_line_to_a_page_a_text_and_a_file(program, tmp_path):
    async with desktop(program(TONE, "tone.src")) as desk:
        await desk.line("results 'x.csv'")
        assert NOTHING_FOUND in desk.output
        await desk.line("spectrum y window 500")
        await over(desk)
        assert "Spectrum of y, tone.src" in desk.output
        page = desk.app.graph.page
        assert page.heading == "Spectrum of y"
        assert page.axes.log_y
        assert not desk.app.graph.work_row.display
        await desk.line("results 'peaks.csv'")
        await desk.until((tmp_path / "peaks.csv").exists)
        await desk.line("spectrum yy")
        await over(desk)
        assert "'yy' is to be recorded" in desk.output


async def test_the_sliders_values_hold(program):
    async with desktop(program(TONE, "tone.src")) as desk:
        await desk.press("f5")
        await desk.until(lambda: desk.app.session.runs and not desk.app.engine.is_busy)
        await desk.line("live w")
        (slider,) = desk.app.graph.sliders.shown
        slider.value = 6.0
        subject = desk.app._controllers["analysis"]._subject()
        assert subject.settings == {"w": 6.0}
        assert subject.name == "tone.src"


async def test_shift_f10_stops_and_keeps_what_was_found(program):
    """What is found so far is shown while it goes on."""
    begun = Event()

    class Endless(Analysis):
        def run(self, subject, request, progress):
            while progress(0.25, "a quarter", Result("a part of it")):
                begun.set()
                begun.wait(0.01)
            return Result("what there is", is_partial=True)

    async with desktop(program(TONE, "tone.src")) as desk:
        actions, spectrum = desk.app._controllers["analysis"], BY_NAME["spectrum"]
        await actions.start(Endless(*(getattr(spectrum, name) for name in Analysis.__match_args__)), "y")
        await desk.until(begun.is_set)
        await desk.until(lambda: "a quarter" in str(desk.app.graph.work_row.content))
        assert "Shift+F10 stops" in str(desk.app.graph.work_row.content)
        await desk.line("spectrum y")
        assert "An analysis goes on" in desk.output
        await desk.press("shift+f10")
        await over(desk)
        assert "what there is (stopped: what was found so far)" in desk.output


def test_a_word_may_fit_a_graph_or_ask_for_a_fit():
    assert parse_line("fit")[0].id == "graph.fit"
    assert parse_line("spectrum y")[0].id == "analysis.spectrum"
    assert parse_line("spectrum = 3") is None
