"""Runs that share a graph, on the desktop: read-out of many curves, and the curve picked out of them."""

from __future__ import annotations

import numpy as np

from desire_tui.engine.graph.colors import PICKED
from desire_tui.panes.graph_key_row import KeyRow
from desire_tui.panes.reading_table import ReadingTable

from .conftest import desktop

STUDY = """\
TMAX = 1 | DT = 0.01 | NN = 101 | scale = 60
for k = 1 to 48
  c = k | drunr | display 2
next
DYNAMIC
d/dt x = c
dispt x
"""


def row(widget, y: int = 0) -> str:
    return widget.render_line(y).text


async def test_a_study_explains_itself(program):
    async with desktop(program(STUDY, "study.src"), size=(100, 40)) as desk:
        await desk.press("f5")
        await desk.idle()
        graph = desk.app.graph
        graph.tick()
        keys, table = graph.query_one(KeyRow), graph.query_one(ReadingTable)
        assert "c = 1 … 48" in row(keys)
        assert "study.src · runs 1–48 · c = 1 … 48 · scale = 60"[-30:] in graph.frame.lines[0]
        high, rows_without_table = graph.room[1], graph.frame.rows
        # a table that pages takes the place of one long row
        graph.focus()
        await desk.press("r")
        await desk.pilot.pause()
        assert table.display
        assert graph.room[1] == high - table.size.height
        assert "48 curves" in row(keys)
        first = row(table)
        assert "c = 1: 0.5" in first
        await desk.press("pagedown")
        assert "c = 1: 0.5" not in row(table)
        assert graph.page is desk.app.session.graph
        # a curve picked by the arrows is told, marked in the table and drawn above the others
        await desk.press("down", "down", "down")
        assert "run 3 · c = 3 · x = 1.5 at t = 0.5" in row(keys)
        assert table.picked == 2
        assert "c = 1: 0.5" in row(table)
        assert PICKED in graph.readout.above.colors
        assert not (graph.canvas.colors == PICKED).any()
        rows, _ = np.nonzero(graph.readout.above.patterns)
        assert (rows.min(), rows.max()) != (0, graph.canvas.rows - 1)  # 3 of 60: a flat one
        await desk.press("escape")
        await desk.pilot.pause()
        assert graph.readout.above is None
        assert not table.display
        assert graph.room[1] == high
        await desk.until(lambda: graph.frame.rows == rows_without_table)
        # the mouse picks the curve it is near to
        frame = graph.frame
        top = frame.top + round((1 - 0.9) / 2 * frame.rows)  # 54 of 60: no curve
        await desk.pilot.hover("#graph", offset=(frame.left + 2, top))
        assert graph.readout.told == ""
        at = frame.left + frame.columns - 1
        height = (1 - 48 / 60) / 2 * frame.rows
        await desk.pilot.hover("#graph", offset=(at, frame.top + int(height)))
        await desk.until(lambda: "run 48 · c = 48" in row(keys))
        await desk.pilot.hover("#prompt")
        assert "c = 1 … 48" in row(keys)


async def test_a_curve_stays_picked_when_the_program_runs_again(program):
    async with desktop(program(STUDY.replace("48", "3")), size=(100, 30)) as desk:
        await desk.press("f5")
        await desk.idle()
        graph = desk.app.graph
        graph.focus()
        await desk.press("r", "down")
        assert "c = 1" in graph.readout.told
        await desk.press("f5")
        await desk.idle()
        graph.tick()
        assert graph.readout.picked is None
        assert graph.reading is not None
