"""Columns of data files in `dispt`, `dispxy`, `DISPXY`: points over the curves, which belong to no run."""

from __future__ import annotations

from io import StringIO

import numpy as np
import pytest

from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.graph.fit import fitted_view, limits
from desire_tui.engine.outputs.csv_file import write_csv
from desire_tui.engine.outputs.matplotlib_figure import draw
from desire_tui.engine.outputs.results import run_data
from desire_tui.engine.outputs.run_plot import plot_run, run_png
from desire_tui.engine.outputs.text_plot import text_plot
from desire_tui.engine.session.listener import Listener
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source
from desire_tui.panes import graph_cursor, picked_curve
from desire_tui.panes.zoom_window import Window

MEASURED = (
    "day;ill;speed;high\n20;0,2;;0,1\n0;1;0;NA\n10;0,5;-0,9;1,4\n25;-0,3;0,5;0,5\n10;0,6;;1,2\n40;9;9;9\n"
)
RUN = "x = 1 | TMAX = 30 | NN = 31 | DT = 0.5\n{script}drun\n{more}DYNAMIC\nd/dt x = -x | y = 0.5*x\n{request}\n"


class Kept(Listener):
    def __init__(self):
        super().__init__()
        self.said = []

    def problems(self, problems):
        self.said += [(p.code, p.line, p.facts) for p in problems]


@pytest.fixture
def ran(tmp_path):
    def made(request, script="", more="", data="data 'm.csv'\n", measured=MEASURED):
        (tmp_path / "m.csv").write_text(measured)
        listener = Kept()
        session = Session(listener, backend="reference", folder=tmp_path)
        text = data + RUN.format(script=script, more=more, request=request)
        assert session.accept(Source(text, "m.src", tmp_path / "m.src")) == ()
        session.run()
        return session, listener.said

    return made


def points(curve):
    return [part.tolist() for part in curve.samples()]


def test_over_t(ran):
    session, said = ran("dispt ill, x, high, y")
    graph = session.graph
    assert [(c.name, c.measured, c.joined) for c in graph.curves] == [
        ("x", False, True), ("y", False, True), ("ill", True, False), ("high", True, False),
    ]  # fmt: skip
    assert len({c.color for c in graph.curves}) == 4
    assert points(graph.curves[2]) == [[0, 10, 10, 20, 25], [1, 0.5, 0.6, 0.2, -0.3]]
    assert points(graph.curves[3]) == [[10, 10, 20, 25], [1.4, 1.2, 0.1, 0.5]]
    assert graph.caption == "x, y, ill, high vs. t"
    assert [(k.name, k.sign) for k in graph.keys] == [("x", "■"), ("y", "■"), ("ill", "×"), ("high", "×")]
    assert limits(graph, fitted_view(graph))[:2] == (0, 30)
    assert limits(graph, fitted_view(graph))[3] >= 1.4
    assert said == []
    file = StringIO()
    write_csv([run_data(session.runs[0])], file)
    assert file.getvalue().startswith("run,t,x,y\n")


def test_drawn_as_markers(ran):
    graph = ran("dispt x, ill")[0].graph
    lines = text_plot(graph, 60, 20, colored=False)
    assert "x   × ill" in lines
    graph.curves = graph.curves[1:]
    assert sum(ord(c) > 0x2800 for c in text_plot(graph, 60, 20, colored=False)) > 4
    axes = draw(graph).axes[0]
    marked = [line for line in axes.lines if line.get_marker() == "o"]
    assert [len(line.get_xdata()) for line in marked] == [5]
    assert marked[0].get_markersize() == 5.0
    many = "t,p\n" + "\n".join(f"{n / 10},0" for n in range(300))
    graph = ran("dispt x, p", measured=many)[0].graph
    assert (
        next(line for line in draw(graph).axes[0].lines if line.get_marker() == "o").get_markersize() == 2.5
    )


def test_columns_over_each_other(ran):
    graph = ran("dispxy ill, high, speed")[0].graph
    assert graph.caption == "high, speed vs. ill"
    assert [(c.name, c.x_name) for c in graph.curves] == [("high", "ill"), ("speed", "ill")]
    assert points(graph.curves[0]) == [[0.5, 0.6, 0.2, -0.3, 9], [1.4, 1.2, 0.1, 0.5, 9]]
    graph = ran("DISPXY x, y, ill, high")[0].graph
    assert graph.caption == "y vs. x, high vs. ill"
    assert [c.measured for c in graph.curves] == [False, True]
    reading = graph_cursor.read(graph, Window(), 0.0)
    assert [name for name, _, _ in reading.values] == ["y"]


def test_runs_that_share_a_page_share_the_points(ran):
    session, _ = ran(
        "dispt x, ill", script="display 2\n", more="t = 0 | x = 2 | drun\nt = 0 | x = 3 | drun\n"
    )
    graph = session.graph
    assert [c.name for c in graph.curves] == ["x", "ill", "x", "x"]
    graph.end_runs()
    assert len({c.color for c in graph.curves if not c.measured}) == 3
    assert [k.name for k in graph.keys][-2:] == ["x(0) = 3", "ill"]
    label = graph_cursor.labels(graph)
    assert [label(c) for c in graph.curves] == ["x(0) = 1", "ill", "x(0) = 2", "x(0) = 3"]
    # what is read from the file between runs are other points
    again = "t = 0 | drun\nconnect 'm.csv' as output 3 | write #3, 't,ill' | write #3, '3,4' | disconnect 3\n"
    session, _ = ran("dispt x, ill", script="display 2\n", more=f"{again}data 'm.csv' | t = 0 | drun\n")
    assert [c.name for c in session.graph.curves] == ["x", "ill", "x", "x", "ill"]
    assert points(session.graph.curves[-1]) == [[3], [4]]


def test_read_out(ran):
    graph = ran("dispt x, ill")[0].graph
    assert graph_cursor.read(graph, Window(), 19 / 30).values[1][2] == "0.2 at 20"
    found = picked_curve.nearest(graph, Window(), (10 / 30, 0.75), (80, 20))
    assert found is not None
    assert graph_cursor.told(graph, *found) == "ill = 0.5 measured at t = 10"


def test_data_that_do_not_overlap_the_run(ran):
    session, said = ran("dispt x, ill", script="t = 100\n")
    assert said == [(537, 7, {"name": "ill", "first": 0, "last": 40, "begin": 100, "end": 130})]
    assert points(session.graph.curves[1]) == [[], []]


def test_columns_of_other_files(ran, tmp_path):
    (tmp_path / "other.csv").write_text("t,wind\n1,5\n2,6\n")
    with pytest.raises(DesireError) as error:
        ran("dispxy wind, ill", data="data 'm.csv' | data 'other.csv'\n")
    assert [(p.code, p.line, p.facts) for p in error.value.diagnostics] == [
        (536, 6, {"y": "ill", "x": "wind"})
    ]
    (tmp_path / "other.csv").write_text("t,wind\n10,5\n20,6\n10,7\n10,8\n")
    graph = ran("dispxy wind, ill", data="data 'm.csv' | data 'other.csv'\n")[0].graph
    assert points(graph.curves[0]) == [[5, 7, 6], [0.5, 0.6, 0.2]]


def test_plots_of_python(ran):
    run = run_data(ran("dispt x, ill, high")[0].runs[0])
    assert [(p.name, p.x_name, p.y[0]) for p in run.points] == [("ill", "t", 1), ("high", "t", 1.4)]
    axes = draw(ran("dispt x")[0].graph).axes[0]
    count = len(axes.lines)
    plot_run(run, ("x", "high"), axes, {})
    assert [line.get_marker() for line in axes.lines[count:]] == ["None", "o"]
    assert np.array_equal(axes.lines[-1].get_xdata(), [10, 10, 20, 25, 40])
    assert run_png((run,))[:4] == b"\x89PNG"
