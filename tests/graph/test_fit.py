"""Graphs that fit their curves, and what is said where curves leave the scale."""

from __future__ import annotations

import numpy as np
import pytest

from desire_tui.engine.graph.fit import WHOLE, Extent, fitted_view, limits
from desire_tui.engine.graph.pages import GraphPages
from desire_tui.engine.outputs.braille_canvas import Canvas
from desire_tui.engine.outputs.incremental_drawing import Painter
from desire_tui.engine.outputs.picture_files import write_picture
from desire_tui.engine.outputs.text_plot import text_plot
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source
from tests.graph.graphing import displayed, page_of, record_of

T = np.linspace(0, 1, 101)
RABBITS = """\
TMAX = 20 | DT = 0.01 | NN = 201
r = 40 | f = 9
{}
drun
DYNAMIC
d/dt r = 0.6*r - 0.05*r*f
d/dt f = 0.02*r*f - 0.5*f
dispt r, f
"""


def fitted(kind, data, *commands):
    page = page_of(kind, T, data, *commands)
    page.fit = "asked"
    return tuple(limits(page, fitted_view(page)))


def test_populations_have_a_frame_from_zero():
    assert fitted("dispt", {"r": 13 + 30 * T, "f": 6 + 14 * T}) == pytest.approx((0, 1, 0, 50))


def test_orbits_are_fitted_both_ways():
    assert fitted("dispxy", {"x": 30 * T - 20, "y": 5 + T}) == pytest.approx((-20, 10, 5, 6))


def test_what_is_not_finite_does_not_count():
    wild = np.where(T > 0.9, np.inf, np.where(T < 0.1, np.nan, 3 * T))
    assert fitted("dispt", {"x": wild, "y": np.full(101, np.nan)}) == pytest.approx((0, 1, 0, 3))


def test_values_beyond_all_reason_are_survived():
    assert fitted("dispt", {"x": 1.7e308 * (T - 0.5) * 2})[2] < -1e308


def test_the_extent_grows_with_the_run_and_forgets_what_is_erased():
    record = record_of("dispt", T, {"x": 10 * T})
    record.count = 11
    pages = GraphPages()
    page = pages.begin_run(record)
    extent = Extent(page)
    assert extent.update()
    assert limits(page, extent.view()).top == pytest.approx(1)
    assert not extent.outside
    assert not extent.update()
    record.count = 101
    assert extent.update()
    assert limits(page, extent.view()).top == pytest.approx(10)
    assert extent.outside
    displayed(pages, "F")
    assert extent.update()
    assert not extent.outside


def test_points_of_the_interpreter_count():
    pages = GraphPages()
    displayed(pages, "A")
    pages.plot(5.0, 7.0, None, 1.0)
    pages.current.fit = "asked"
    view = limits(pages.current, fitted_view(pages.current))
    assert view.left < 5 < view.right
    assert view.bottom < 7 < view.top


def test_clip_marks_stand_where_curves_leave():
    canvas = Canvas(10, 4)
    painter = Painter(canvas, page_of("dispt", T, {"x": np.where(T < 0.5, 3.0, -3.0)}))
    painter.update()
    assert painter.clipped.above.tolist() == [True] * 5 + [False] * 5
    assert painter.clipped.below.tolist() == [False] * 5 + [True] * 5
    painter = Painter(canvas, page_of("dispxy", T, {"x": 4 * T - 2, "y": 0 * T + 0.9}))
    painter.update()
    assert painter.clipped.left.tolist() == painter.clipped.right.tolist() == [True, False, False, False]


def test_a_text_plot_marks_and_counts_curves_outside():
    text = text_plot(page_of("dispt", T, {"x": 3 * T, "y": 2 + T}), 80, 24, colored=False)
    assert "2 curves outside" in text
    assert "▲" in text
    assert "▼" not in text
    inside = text_plot(page_of("dispt", T, {"x": T}), 80, 24, colored=False)
    assert "outside" not in inside
    assert "▲" not in inside
    bare = text_plot(page_of("dispt", T, {"x": 3 + T}, "C16"), 80, 24, colored=False)
    assert "1 curve outside" in bare


@pytest.mark.parametrize(
    ("setting", "fit", "title"),
    [
        ("", True, "r.src · run 1 · fitted"),
        ("scale = 50", False, "r.src · run 1 · scale = 50"),
        ("scale = 1", False, "r.src · run 1 · scale = 1"),
        ("scale = 10 | display fit", True, "r.src · run 1 · fitted"),
    ],
)
def test_the_programs_scale_holds_where_it_sets_one(setting, fit, title):
    session = Session()
    session.erun(Source(RABBITS.format(setting), "/somewhere/r.src"))
    view = fitted_view(session.graph)
    assert (view != WHOLE) == fit
    assert session.graph.title(fitted=fit) == title
    if fit:
        assert limits(session.graph, view)[2:] == pytest.approx((0, 50))


def test_without_a_scale_curves_inside_keep_the_frame_of_the_original():
    session = Session()
    session.erun(Source(RABBITS.format("r = 0.4 | f = 0.3 | TMAX = 1 | NN = 11")))
    assert fitted_view(session.graph) == WHOLE


def test_display_fit_as_a_command_fits_the_graph_shown():
    session = Session()
    session.erun(Source(RABBITS.format("scale = 1")))
    session.execute("display fit")
    assert fitted_view(session.graph) != WHOLE


def test_long_names_give_way_to_run_and_scale():
    page = page_of("dispt", T, {"x": T})
    page.program = "a_program_of_a_long_name.src"
    assert page.title(room=32) == "a_program_o… · run 1 · scale = 1"
    assert len(page.title(room=32)) <= 32
    assert page.title(room=20) == "run 1 · scale = 1"


def test_titles_and_names_of_axes(tmp_path):
    session = Session()
    texts = "title 'Foxes' | xlabel 'years' | ylabel 'heads' | scale = 50"
    session.erun(Source(RABBITS.format(texts), "r.src"))
    page = session.graph
    assert page.title() == "Foxes · scale = 50"
    assert "heads vs. years" in text_plot(page, 80, 24, colored=False)
    write_picture(page, tmp_path / "g.svg")
    svg = (tmp_path / "g.svg").read_text()
    assert all(f">{text}<" in svg for text in ("Foxes", "years", "heads"))
    session.execute("title 'Hares'")
    assert page.title() == "Hares · scale = 50"


def test_a_title_after_the_run_names_a_graph_without_one():
    session = Session()
    session.erun(Source(RABBITS.format("scale = 50").replace("drun", "drun | title 'A' | drunr | title 'B'")))
    assert [page.heading for page in session.graphs] == ["A", "A"]


def test_names_of_axes_are_those_of_the_request_unless_the_program_names_them():
    page = page_of("dispxy", T, {"x": T, "y": T})
    assert page.axis_names == ("x", "y")
    page.texts["xlabel"] = "place"
    assert page.label == "y vs. place"
    assert page_of("DISPXY", T, {"a": T, "b": T, "c": T, "d": T}).axis_names is None
