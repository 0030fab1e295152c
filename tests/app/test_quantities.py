"""Quantities, sliders, live mode."""

from __future__ import annotations

import math

import pytest

from desire_tui.panes.slider import Slider

from .conftest import OSCILLATOR, desktop

PARAMETER = OSCILLATOR.replace("x = 1\n", "x = 1 | w = 1\n", 1).replace("-x", "-w*w*x")


async def test_values_filter_and_edit(program):
    async with desktop(program(PARAMETER + "-- end\n"), size=(120, 40)) as desk:
        await desk.press("f5")
        await desk.idle()
        await desk.press("alt+q")
        pane = desk.app.quantities
        table = pane.table
        shown = {table.get_row_at(n)[0]: table.get_row_at(n)[1] for n in range(table.row_count)}
        assert shown["w"] == "1"
        assert float(shown["x"]) == pytest.approx(math.cos(6), abs=1e-4)
        assert shown["TMAX"] == "6"
        assert "PI" not in shown
        pane.query_one("#filter").value = "tm"
        await desk.pilot.pause()
        assert [table.get_row_at(n)[0] for n in range(table.row_count)] == ["TMAX"]
        table.focus()
        await desk.press("enter")
        field = pane.query_one("#edit")
        assert field.value == "TMAX = 6"
        field.value = "TMAX = 2*PI"
        await desk.press("enter")
        await desk.idle()
        assert desk.app.session.values.cells[1] == pytest.approx(2 * math.pi)


async def test_live_mode_reruns_with_the_sliders_value(program):
    async with desktop(program(PARAMETER), size=(120, 40)) as desk:
        await desk.press("f5")
        await desk.idle()
        await desk.line("live w")
        slider = desk.app.graph.query_one(Slider)
        assert slider.value == 1.0
        slider.focus()
        await desk.press("right", "right")
        await desk.until(lambda: desk.app.live_mode.runs_made and not desk.app.engine.is_busy)
        assert slider.value == pytest.approx(1.04)
        cells, find = desk.app.session.values.cells, desk.app.session.values.find
        assert cells[find("w").slot] == pytest.approx(1.04)
        assert cells[find("x").slot] == pytest.approx(math.cos(1.04 * 6), abs=1e-4)
        # a run from the keys takes the program's own value again
        await desk.press("f5")
        await desk.idle()
        assert desk.app.session.values.cells[desk.app.session.values.find("w").slot] == 1.0
        assert slider.value == 1.0


async def test_live_runs_overlay_when_asked(program):
    async with desktop(program(PARAMETER), size=(120, 40)) as desk:
        await desk.press("f5")
        await desk.idle()
        await desk.do("run.live_overlay")
        await desk.line("live w")
        desk.app.graph.query_one(Slider).focus()
        await desk.press("right")
        await desk.until(lambda: desk.app.live_mode.runs_made == 1 and not desk.app.engine.is_busy)
        desk.app.graph.tick()
        assert len(desk.app.graph._painter.graph.curves) == 4


async def test_a_slider_for_something_without_a_value_is_refused(program):
    async with desktop(program(PARAMETER)) as desk:
        await desk.line("live nothing")
        await desk.pilot.pause()
        assert not desk.app.graph.query(Slider)


async def test_live_mode_only_keeps_the_newest_value(program):
    """However fast the slider moves, the last value is the one that was run last."""
    async with desktop(program(PARAMETER), size=(120, 40)) as desk:
        await desk.press("f5")
        await desk.idle()
        for step in range(1, 21):
            desk.app.live_mode.ask({"w": 1 + step / 100}, overlay=False)
        await desk.until(lambda: desk.app.live_mode.runs_made and not desk.app.engine.is_busy)
        await desk.pilot.pause()
        await desk.idle()
        assert desk.app.live_mode.runs_made < 20
        cells, find = desk.app.session.values.cells, desk.app.session.values.find
        assert cells[find("w").slot] == pytest.approx(1.2)
