"""The graph pane: window, pages, read-out, paper."""

from __future__ import annotations

import csv
import math
import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from textual.widgets import Input

from desire_tui.engine.graph.colors import rgb
from desire_tui.engine.outputs import braille_canvas as engine_canvas
from desire_tui.panes import graph_sheet, graph_styles
from desire_tui.panes.zoom_window import Window

from .conftest import LONG, OSCILLATOR, desktop

parts = st.floats(0.01, 0.99)


@given(st.floats(0.1, 10), parts, parts)
def test_zooming_keeps_the_point_in_place_and_back_gives_the_window_back(factor: float, x: float, y: float):
    before = Window(0.1, 0.7, -0.2, 0.9)
    after = before.zoomed(factor, x, y)
    for low, high, low2, high2, part in (
        (before.left, before.right, after.left, after.right, x),
        (before.bottom, before.top, after.bottom, after.top, y),
    ):
        assert math.isclose(low + part * (high - low), low2 + part * (high2 - low2), abs_tol=1e-9)
    assert after.zoomed(1 / factor, x, y) == pytest.approx(before)


@given(st.floats(-3, 3), st.floats(-3, 3))
def test_panning_there_and_back(x: float, y: float):
    assert Window().panned(x, y).panned(-x, -y) == pytest.approx(Window())


def test_a_part_of_the_window():
    assert Window().part(0.25, 0.75, 0.0, 0.5) == (0.25, 0.75, 0.0, 0.5)
    assert Window().part(0.25, 0.75, 0.0, 0.5).part(0.5, 1.0, 0.5, 1.0) == (0.5, 0.75, 0.25, 0.5)


def test_the_tiles_agree_with_the_canvas():
    assert graph_sheet.TILE_COLUMNS == engine_canvas.TILE_COLUMNS
    assert graph_styles.NO_COLOR == engine_canvas.NO_COLOR


def test_curve_colours_follow_the_paper():
    assert graph_styles.curve_style(14, white=False).color.get_truecolor() == rgb(14, white=False)
    assert graph_styles.curve_style(14, white=True).color.get_truecolor() == rgb(14, white=True)


async def test_zoom_pan_reset_and_readout(program):
    async with desktop(program(OSCILLATOR), size=(120, 40)) as desk:
        await desk.press("f5")
        await desk.idle()
        graph = desk.app.graph
        graph.focus()
        graph.tick()
        labels = "\n".join(graph.frame.lines)
        assert " 3 " in labels
        await desk.press("plus")
        graph.tick()
        assert graph.window == (0.25, 0.75, 0.25, 0.75)
        zoomed = "\n".join(graph.frame.lines)
        assert "1.5" in zoomed
        assert "4.5" in zoomed
        assert "zoom" in graph.page_mark
        await desk.press("right")
        assert graph.window.left > 0.25
        await desk.press("0")
        assert graph.window.is_whole
        await desk.press("r")
        assert graph.reading is not None
        assert graph.reading.head == "t = 3"
        values = {name: float(value) for name, _, value in graph.reading.values}
        assert values["x"] == pytest.approx(math.cos(3), abs=1e-4)
        assert values["v"] == pytest.approx(-math.sin(3), abs=1e-4)
        column = graph.cursor_column
        await desk.press("shift+right")
        assert graph.cursor_column == column + 5
        await desk.press("escape")
        assert graph.reading is None


async def test_dragging_zooms_into_the_rectangle(program):
    async with desktop(program(OSCILLATOR), size=(120, 40)) as desk:
        await desk.press("f5")
        await desk.idle()
        graph = desk.app.graph
        graph.tick()
        await desk.pilot.pause()
        frame = graph.frame
        width, height = frame.columns, frame.rows
        left, top = graph.content_region.x + frame.left, graph.content_region.y + frame.top
        await desk.pilot.mouse_down(offset=(left, top))
        await desk.pilot.hover(offset=(left + width // 2 - 1, top + height // 2))
        assert graph.rubber is not None
        await desk.pilot.mouse_up(offset=(left + width // 2 - 1, top + height // 2))
        assert graph.window.left < 0.05
        assert abs(graph.window.right - 0.5) < 0.05
        assert graph.window.top == pytest.approx(1.0)
        assert graph.window.bottom == pytest.approx(1 - (height // 2 + 1) / height)


async def test_pages_and_overlay(program):
    text = OSCILLATOR.replace("drun\n", "drunr | drunr | drunr\n")
    async with desktop(program(text)) as desk:
        await desk.press("f5")
        await desk.idle()
        graph, pages = desk.app.graph, list(desk.app.session.graphs)
        assert len(pages) == 3
        assert graph.page is pages[2]
        await desk.press("alt+pageup")
        assert graph.page is pages[1]
        assert "page 2/3" in graph.page_mark
        await desk.press("alt+pageup", "alt+pageup", "alt+pageup")
        assert graph.page is pages[0]
        await desk.press("alt+pagedown", "alt+pagedown")
        assert graph.page is pages[2]
        await desk.press("alt+o")
        graph.tick()
        drawn = graph._painter.graph.curves
        assert len(drawn) == 4
        assert len({curve.color for curve in drawn}) == 4  # each run has its shades of the curves' own hues
        assert {curve.hue for curve in drawn[:2]} == {curve.hue for curve in drawn[2:]}
        assert {key.color for key in graph.paging.keys} >= {curve.color for curve in drawn[2:]}
        await desk.press("alt+o")
        graph.tick()
        assert graph._painter.graph.curves == pages[2].curves


async def test_what_is_drawn_does_not_depend_on_when_it_was_drawn(program):
    """A picture that grew with the run equals one drawn at its end."""
    async with desktop(program(OSCILLATOR)) as desk:
        await desk.press("f5")
        await desk.idle()
        graph = desk.app.graph
        graph.tick()
        grown = graph.canvas.patterns.copy()
        graph._drawn = ()
        graph.tick()
        assert np.array_equal(grown, graph.canvas.patterns)


async def test_white_paper_by_program_and_by_theme(program):
    async with desktop(program("display N-9\n" + OSCILLATOR)) as desk:
        await desk.press("f5")
        await desk.idle()
        assert desk.app.graph.is_white
    async with desktop(program(OSCILLATOR)) as desk:
        assert not desk.app.graph.is_white
        await desk.line("theme light")
        assert desk.app.graph.is_white


async def test_interpreter_plot_strip_chart_phase_plane_and_picture(program):
    text = """\
display A
for i = 1 to 50 | plot i/50, (i/50)^2, 12 | next
"""
    async with desktop(program(text)) as desk:
        await desk.press("f5")
        await desk.idle()
        graph = desk.app.graph
        graph.tick()
        # the points lie on a parabola in the upper right quarter
        rows, columns = np.nonzero(graph.canvas.patterns)
        assert columns.min() >= graph.canvas.columns // 2 - 1
        assert rows.max() <= graph.canvas.rows // 2
        assert set(graph.canvas.colors[rows, columns]) == {12}
        desk.app.editor.front.load_text("ARRAY A[2,2]\nA[1,1] = 1\nSHOW A\n")
        await desk.press("f5")
        await desk.idle()
        if graph.page.frame.kind == "picture":
            graph.tick()
            half = graph.canvas.patterns.shape[0] // 2, graph.canvas.patterns.shape[1] // 2
            assert graph.canvas.patterns[: half[0], : half[1]].any()
            assert not graph.canvas.patterns[half[0] + 1 :].any()
        desk.app.editor.front.load_text(OSCILLATOR.replace("dispt x, v", "dispxy x, v"))
        await desk.press("f5")
        await desk.idle()
        graph.tick()
        assert graph.page.caption == "v vs. x"
        await desk.do("graph.read")
        reading = graph.reading
        assert reading.head.startswith("t = 3  x = ")
        assert float(reading.values[0][2]) == pytest.approx(-math.sin(3), abs=1e-3)


async def test_snapshot_and_export(program, tmp_path):
    async with desktop(program(OSCILLATOR)) as desk:
        await desk.line("snapshot 'early.png'")
        assert not (tmp_path / "early.png").exists()
        await desk.press("f5")
        await desk.idle()
        await desk.line("snapshot 'g.svg'")
        await desk.until((tmp_path / "g.svg").exists)
        await desk.until(lambda: "g.svg" in desk.output.split("snapshot")[-1])
        # size and resolution are typed behind the name
        await desk.do("graph.snapshot")
        await desk.pilot.pause()
        desk.app.screen.query_one(Input).value = "small.png 4x3 50dpi"
        await desk.press("enter")
        await desk.until(lambda: "small.png" in desk.output)
        width, height = struct.unpack(">II", (tmp_path / "small.png").read_bytes()[16:24])
        assert (width, height) == (200, 150)
        await desk.line("snapshot 'big.png' 900x4")
        assert "no picture is made with 900x4" in desk.output
        await desk.line("export 'g.csv'")
        await desk.until((tmp_path / "g.csv").exists)
        table = np.genfromtxt(tmp_path / "g.csv", delimiter=",", names=True)
        assert table.dtype.names == ("t", "x", "v")
        assert np.allclose(table["x"], np.cos(table["t"]), atol=1e-6)


async def test_an_exported_array_element_is_one_column(program, tmp_path):
    text = "ARRAY A[1,2]\nNN = 3 | TMAX = 1 | t = 0\ndrun\nDYNAMIC\nA[1,2] = t / 3\ndispt A[1,2]\n"
    async with desktop(program(text)) as desk:
        await desk.press("f5")
        await desk.idle()
        await desk.line("export 'g.csv'")
        await desk.until((tmp_path / "g.csv").exists)
        head, *rows = csv.reader((tmp_path / "g.csv").read_text().splitlines())
        assert head == ["t", "A[1,2]"]
        assert [[float(cell) for cell in row] for row in rows] == [[0.0, 0.0], [0.5, 0.5 / 3], [1.0, 1 / 3]]


async def test_full_screen_and_back(program):
    async with desktop(program(OSCILLATOR), size=(80, 24)) as desk:
        await desk.press("f5")
        await desk.idle()
        narrow = desk.app.graph.size.width
        await desk.press("f7")
        await desk.pilot.pause()
        assert desk.app.graph.size.width > 70 > narrow
        await desk.press("f7")
        await desk.pilot.pause()
        assert desk.app.graph.size.width == narrow


@pytest.mark.parametrize("request_line", ["dispt y, z", "dispxy y, z", "DISPXY y, z"])
async def test_the_cursor_reads_a_gap_where_a_sample_is_no_number(program, request_line: str):
    text = f"TMAX = 4 | DT = 0.5 | NN = 5\ndrun\nDYNAMIC\nd/dt x = 1\ny = sqrt(1 - x)\nz = 1/(x - 4)\n{request_line}\n"
    async with desktop(program(text), size=(120, 40)) as desk:
        await desk.press("f5")
        await desk.idle()
        graph = desk.app.graph
        graph.tick()
        await desk.pilot.pause()
        graph.focus()
        await desk.press("r")
        for _ in range(20):
            await desk.press("shift+right")
        read = {name: value for name, _, value in graph.reading.values}
        assert read["z"] == "–"
        if request_line.startswith("dispt"):
            assert read["y"] == "–"
        else:
            assert "y = –" in graph.reading.head


RABBITS = """\
TMAX = 20 | DT = 0.01 | NN = 201
r = 40 | f = 9 | scale = 10
drun
DYNAMIC
d/dt r = 0.6*r - 0.05*r*f
d/dt f = 0.02*r*f - 0.5*f
dispt r, f
"""


def shown(graph) -> str:
    tiles = range(graph.size.width // 8 + 1)
    return "\n".join("".join(graph.sheet.piece(n, y).text for n in tiles) for y in range(graph.size.height))


async def test_curves_outside_are_said_and_fitted_by_a_key(program):
    async with desktop(program(RABBITS), size=(80, 24)) as desk:
        await desk.press("f5")
        await desk.idle()
        graph = desk.app.graph
        graph.tick()
        assert "2 outside · Shift+F7 fits" in shown(graph)  # shortened: the marks are seen beside it
        assert "▲" in shown(graph)
        await desk.press("alt+f")
        text = shown(graph)
        assert "outside" not in text
        assert "▲" not in text
        assert "fitted" in text
        assert "50" in text
        assert "zoom" not in text
        await desk.press("alt+0")
        assert "2 outside" in shown(graph)
        await desk.line("fit")
        assert "fitted" in shown(graph)
        await desk.press("f5")  # the next run of the same variables is fitted too
        await desk.idle()
        graph.tick()
        assert "fitted" in shown(graph)


async def test_a_first_model_without_scale_is_fitted_and_the_graph_names_it(program):
    async with desktop(program(RABBITS.replace(" | scale = 10", "")), size=(120, 36)) as desk:
        await desk.press("f5")
        await desk.idle()
        desk.app.graph.tick()
        text = shown(desk.app.graph)
        assert "run 1 · fitted" in text
        assert ".src · run 1" in text


async def test_fitting_follows_a_run_that_goes_on(program):
    text = LONG.replace("d/dt x = v", "d/dt x = 1")
    async with desktop(program(text)) as desk:
        await desk.press("f5", "alt+f")
        graph = desk.app.graph
        await desk.until(lambda: graph.page is not None and graph.page.curves[0].count > 10)
        graph.tick()
        first = graph.window
        await desk.until(lambda: graph.window.top > 2 * first.top)
        await desk.press("shift+f10")
        await desk.idle()


async def test_a_failed_start_does_not_leave_another_programs_graph(program):
    good, bad = program(OSCILLATOR, "good.src"), program("write 1/0\n" + OSCILLATOR, "bad.src")
    async with desktop(good, size=(120, 36)) as desk:
        await desk.press("f5")
        await desk.idle()
        graph = desk.app.graph
        graph.tick()
        assert "good.src · run 1" in shown(graph)
        await desk.line(f"load '{bad}'")
        await desk.press("f5")
        await desk.idle()
        assert "bad.src made no graph" in shown(graph)
        assert "good.src" not in shown(graph)
        await desk.press("alt+pageup")
        assert "good.src · run 1" in shown(graph)


async def test_a_graph_of_before_a_failed_start_is_marked(program):
    async with desktop(program(OSCILLATOR)) as desk:
        await desk.press("f5")
        await desk.idle()
        graph = desk.app.graph
        desk.app.editor.front.text = OSCILLATOR.replace("drun", "write 1/0 | zap | drun")
        await desk.press("f5")
        await desk.idle()
        assert "earlier run" in shown(graph)
        await desk.until(lambda: desk.app.main_screen.status_bar.text.endswith(" did not run"))
        desk.app.editor.front.text = OSCILLATOR
        await desk.press("f5")
        await desk.idle()
        graph.tick()
        assert "earlier run" not in shown(graph)
        assert desk.app.main_screen.status_bar.text.startswith("run 1")


async def test_a_mark_covers_no_part_of_the_title(program):
    async with desktop(program(OSCILLATOR), size=(100, 30)) as desk:
        await desk.press("f5")
        await desk.idle()
        graph = desk.app.graph
        graph.fit_curves()
        graph.show_failed(graph.page.program)
        await desk.until(lambda: "earlier run" in shown(graph))
        assert shown(graph).splitlines()[0].endswith("· fitted earlier run ")


async def test_the_cursor_reads_nothing_where_the_run_has_not_come(program):
    text = "TMAX = 4 | DT = 0.01 | NN = 401 | scale = 9\ndrun\nDYNAMIC\nd/dt x = 1\nterm x - 1\ndispt x\n"
    async with desktop(program(text), size=(120, 40)) as desk:
        await desk.press("f5")
        await desk.idle()
        graph = desk.app.graph
        graph.tick()
        graph.focus()
        await desk.press("r")
        assert graph.reading.head == "t = 2"
        assert [value for _, _, value in graph.reading.values] == ["–"]


async def test_pages_of_quantities_have_a_title(program):
    async with desktop(program(OSCILLATOR), size=(120, 36)) as desk:
        await desk.press("f5")
        await desk.idle()
        await desk.line("graph x")
        await desk.idle()
        desk.app.graph.tick()
        assert "osc.src · run 1 · fitted" in shown(desk.app.graph)
