"""Runs that share a graph: what varies, what each is called, and its colour."""

from __future__ import annotations

import io
import json

import numpy as np
import pytest

import desire_tui
from desire_tui.engine.graph.color_keys import short_names
from desire_tui.engine.graph.colors import GHOST, PICKED, RAMP, curve_rgb
from desire_tui.engine.outputs.csv_file import write_csv
from desire_tui.engine.outputs.json_file import as_json
from desire_tui.engine.outputs.matplotlib_figure import draw
from desire_tui.engine.outputs.npz_file import write_npz
from desire_tui.engine.outputs.text_plot import text_plot
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source

STUDY = """\
TMAX = 1 | DT = 0.1 | NN = 11 | w = 2
{loop}
  drunr | display 2
{end}
DYNAMIC
d/dt x = -c*x
y = w*x
dispt {shown}
"""
FIVE = "for k = 1 to 5 | c = 0.3*k | x = 1"


def study(loop=FIVE, end="next", shown="x", before="", source=STUDY):
    session = Session(backend="reference")
    session.erun(Source(before + source.format(loop=loop, end=end, shown=shown), "study.src"))
    return session


def keys(session):
    return [key.name for key in session.graph.keys]


def colors(session):
    return [curve.color for curve in session.graph.curves]


def test_the_keys_and_the_title_name_what_the_script_changed():
    session = study()
    assert keys(session) == ["c = 0.3", "c = 0.6", "c = 0.9", "c = 1.2", "c = 1.5"]
    assert session.graph.title() == "study.src · runs 1–5 · c = 0.3 … 1.5 · scale = 1"
    assert len(set(colors(session))) == 5
    assert min(colors(session)) >= RAMP
    assert short_names(session.graph.keys) == ["c = 0.3", "0.6", "0.9", "1.2", "1.5"]
    assert "c = 0.3   c = 0.6" in text_plot(session.graph, 80, 20, colored=False)


def test_many_runs_have_one_key_for_each_variable_with_some_of_its_colours():
    session = study("for k = 1 to 30 | c = k | x = 1", shown="x, y")
    assert keys(session) == ["x, c = 1 … 30", "y, c = 1 … 30"]
    first, second = (key.colors for key in session.graph.keys)
    assert 4 <= len(set(first)) <= 8
    assert not set(first) & set(second)


@pytest.mark.parametrize(
    ("loop", "expected"),
    [
        ("data 3, 1, 2 | for k = 1 to 3 | read c | x = 1", ["c = 3", "c = 1", "c = 2"]),
        ("for k = 1 to 2 | c = k | x = 10 - k", ["c = 1, x(0) = 9", "c = 2, x(0) = 8"]),
        # d goes in step with c: it says nothing new
        ("for k = 1 to 3 | c = k | d = 10 + 2*k | x = 1", ["x, c = 1", "y, c = 1", "x, c = 2", "y, c = 2", "x, c = 3", "y, c = 3"]),
        ("c = 1 | for k = 1 to 2 | x = k", ["x(0) = 1", "x(0) = 2"]),
        ("c = 1 | for k = 1 to 2 | x = 1", ["run 1", "run 2"]),
        ("x = 1 | for k = 1 to 2 | c = 1 + k/1000", ["c = 1.001", "c = 1.002"]),
    ],
)  # fmt: skip
def test_what_a_run_is_called(loop, expected):
    source = STUDY.replace("w*x", "w*x + d") if "d =" in loop else STUDY
    assert keys(study(loop, source=source, shown="x, y" if "d =" in loop else "x")) == expected


def test_runs_that_go_on_are_not_called_by_where_they_begin():
    source = STUDY.replace("drunr", "drun")
    assert keys(study("c = 1 | x = 1 | for k = 1 to 3", source=source)) == ["run 1", "run 2", "run 3"]
    assert keys(study("x = 1 | for k = 1 to 3 | c = k", source=source)) == ["c = 1", "c = 2", "c = 3"]


def test_colours_that_the_program_gives_to_its_runs_stay():
    session = study(FIVE + " | n = 9 + k | display N n")
    assert colors(session) == [10, 11, 12, 13, 14]
    assert keys(session)[:2] == ["c = 0.3", "c = 0.6"]
    one = study(before="display N18\n")
    assert set(colors(one)) == {15}
    assert keys(one) == []


def test_the_ramp_is_laid_out_anew_when_the_number_of_runs_was_not_known():
    session = study("c = 0 | repeat | c = c + 1 | x = 1", "until c > 5.5")
    assert colors(session) == colors(study("for k = 1 to 6 | c = k | x = 1"))
    assert session.graph.erased > 0
    session.execute("x = 1 | c = 9 | drun")
    assert len(set(colors(session))) == 7
    assert session.graph.title().count("c = 1 … 9") == 1


@pytest.mark.parametrize("white", [True, False])
def test_every_colour_of_a_ramp_can_be_seen(white: bool):
    def luminance(color):
        parts = [
            part / 255 / 12.92 if part <= 10 else ((part / 255 + 0.055) / 1.055) ** 2.4 for part in color
        ]
        return 0.2126 * parts[0] + 0.7152 * parts[1] + 0.0722 * parts[2]

    paper = 1.0 if white else luminance((11, 13, 17))
    for color in (*range(RAMP, GHOST), PICKED):
        light, dark = sorted((paper, luminance(curve_rgb(color, white=white))), reverse=True)
        assert (light + 0.05) / (dark + 0.05) >= 2.7, color  # as the darkest bright colour of the original


def test_results_keep_what_each_run_started_with():
    text = STUDY.format(loop=FIVE + " | q[2] = k", end="next", shown="x").replace("w*x", "w*x + q[2]")
    result = desire_tui.run("ARRAY q[2], big[20]\n" + text)
    run = result.runs[2]
    assert run.parameters == {"w": 2.0, "c": pytest.approx(0.9), "q[2]": 3.0}
    assert run.initial == {"x": 1.0}
    assert not run.continues
    assert json.loads(as_json(result))["runs"][4]["parameters"]["c"] == 1.5
    table = io.StringIO()
    write_csv(result.runs, table)
    head, first, *_, last = table.getvalue().splitlines()
    assert head == "run,t,x,c,q[2]"
    assert first == "1,0.0,1.0,0.3,1.0"
    assert last.endswith(",1.5,5.0")
    archive = io.BytesIO()
    write_npz(result, archive)
    archive.seek(0)
    numbers = np.load(archive)
    assert numbers["parameters/c"] == pytest.approx([0.3, 0.6, 0.9, 1.2, 1.5])
    assert numbers["initial/x"].tolist() == [1.0] * 5


def test_what_only_events_read_are_parameters_and_what_they_set_is_none():
    session = Session(backend="reference")
    session.erun(
        Source(
            "y = 50 | keep = 0.8 | T = 7 | n = 0 | irule 3 | TMAX = 20 | DT = 0.01 | NN = 21\ndrun\nDYNAMIC\n"
            "d/dt y = v\nd/dt v = -9.8\ndispt y\nevent -y\nv = -keep*v | y = 0 | n = n + 1\nevery T\nn = n + 1\n"
        )
    )
    start = session.runs[-1].start
    assert start.parameters == {"keep": 0.8, "T": 7.0}
    assert start.initial == {"y": 50.0, "v": 0.0}


def test_long_keys_and_titles_stay_within_the_picture():
    session = study("for k = 1 to 4 | parameter_of_length = 1234567 + k | c = k^3 | x = sin(k)",
                    source=STUDY.replace("-c*x", "-c*x + 0*parameter_of_length"))  # fmt: skip
    figure = draw(session.graph)
    figure.canvas.draw()
    box = figure.legends[0].get_window_extent()
    assert 0 <= box.x0 < box.x1 <= figure.bbox.width
    title = figure.axes[0].title.get_text() or figure.axes[0]._left_title.get_text()
    assert figure.axes[0]._left_title.get_window_extent().x1 <= figure.bbox.width, title
    assert session.graph.title(room=20) == "study.src · runs 1–4"
