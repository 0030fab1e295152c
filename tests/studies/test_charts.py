"""Charts of a study: of numbers whose distribution is known."""

from __future__ import annotations

import re

import numpy as np
import pytest

from desire_tui.engine.graph.cells import cell_ticks
from desire_tui.engine.graph.pages import GraphPages
from desire_tui.engine.outputs.matplotlib_figure import draw
from desire_tui.engine.outputs.text_frame import text_frame
from desire_tui.engine.source import Source
from desire_tui.studies.chart_page import begin_page, update_page
from desire_tui.studies.charts import CHART_KINDS, Chart, Results, chart, usual_kind
from desire_tui.studies.command import planned
from desire_tui.studies.dataset import layouts
from desire_tui.studies.typed_options import typed_options

LINE = """a = 1 | b = 0 | x = 0 | DT = 0.01 | TMAX = 1 | NN = 11
drun
DYNAMIC
d/dt x = a + b
dispt x
"""
"""x = (a + b) t, exactly."""


def results(options, number=0):
    study = planned(Source(LINE, "line.src"), typed_options(options))
    study.run(threads=1)
    layout = layouts(study.plan)[number]
    return Results(study.plan, layout, study.store.numbers(layout))


def test_a_fan_has_the_quantiles_of_the_runs():
    drawn = chart(results("--over a=0:100:101 --keep x@0:1:0.5"), "fan")
    assert drawn.x.tolist() == [0, 0.5, 1]
    assert [line.name for line in drawn.lines] == ["5 %", "25 %", "median", "75 %", "95 %"]
    for line, part in zip(drawn.lines, (5, 25, 50, 75, 95), strict=True):
        assert line.y == pytest.approx([0, part / 2, part])


def test_the_bands_of_a_fan_are_filled_on_paper():
    drawn = chart(results("--over a=0:100:101 --keep x@0:1:0.5"), "fan")
    (axes,) = draw(begin_page(GraphPages(), drawn, "line.src")).axes
    heights = sorted(np.ptp(band.get_paths()[0].vertices[:, 1]) for band in axes.collections)
    assert heights[0] / heights[1] == pytest.approx(75 / 95)
    drawn = chart(results("--over a=1:5:5 --keep x@0:1:0.5"), "curves")
    assert not draw(begin_page(GraphPages(), drawn, "line.src")).axes[0].collections


@pytest.mark.parametrize(("runs", "width"), [(10, 5), (400, 2.5), (20_000, 0.88)])
def test_points_on_paper_are_the_smaller_the_more_there_are(runs, width):
    drawn = chart(results(f"--over a=0:1:{runs} --keep x[end]"), "scatter")
    (axes,) = draw(begin_page(GraphPages(), drawn, "line.src")).axes
    assert axes.lines[0].get_markersize() == pytest.approx(width)


def test_curves_are_named_by_what_varied_and_go_along_the_ramp():
    drawn = chart(results("--over a=1:3:3 --keep x@0:1:0.5"), "curves")
    assert [line.name for line in drawn.lines] == ["a = 1", "a = 2", "a = 3"]
    assert [line.part for line in drawn.lines] == [0, 0.5, 1]
    assert drawn.lines[2].y == pytest.approx([0, 1.5, 3])


def test_curves_of_drawn_runs_have_the_colours_of_a_quantity_that_varies():
    study = results("--sample a=normal(0,1), b=uniform(0,1) --runs 5 --keep x@0:1:0.5")
    for name, column in (("", 0), ("a", 0), ("b", 1)):
        along = study.plan.design.rows(0, 5)[:, column]
        drawn = chart(study, "curves", name)
        assert [line.part for line in drawn.lines] == pytest.approx((along - along.min()) / np.ptp(along))
        assert f" · {name or 'a'} = {along.min():.4g} … " in drawn.title


def test_a_histogram_counts_every_run_once():
    drawn = chart(results("--over a=0:99:100 --keep x[end]"), "histogram")
    tops = drawn.lines[0].y[1::4]
    assert tops.sum() == 100
    assert tops == pytest.approx(np.full(10, 10))
    assert (drawn.x[0], drawn.x[-1]) == pytest.approx((0, 99))


def test_the_cumulated_distribution_rises_from_0_to_1():
    drawn = chart(results("--over a=1:4:4 --keep x[end]"), "cumulated")
    assert drawn.x == pytest.approx([1, 1, 2, 2, 3, 3, 4, 4])
    assert drawn.lines[0].y == pytest.approx([0, 0.25, 0.25, 0.5, 0.5, 0.75, 0.75, 1])


def test_a_number_over_a_parameter_and_over_drawn_runs_its_quantiles():
    drawn = chart(results("--over a=1:3:3 --keep x[end]"), "over")
    assert (drawn.x_name, drawn.lines[0].y.tolist()) == ("a", pytest.approx([1, 2, 3]))
    drawn = chart(results("--over a=1:3:3 --sample b=uniform(0,1) --runs 400 --keep x[end]"), "over")
    for line, part in zip(drawn.lines, (0.05, 0.25, 0.5, 0.75, 0.95), strict=True):
        assert line.y == pytest.approx(np.array([1, 2, 3]) + part, abs=0.1)


def test_a_map_has_a_row_for_each_value_of_the_first_quantity():
    drawn = chart(results("--over a=0:1:2 --over b=0:2:3 --keep x[end]"), "map")
    assert drawn.picture == pytest.approx(np.array([[0, 1, 2], [1, 2, 3]]) / 3)
    assert drawn.title.endswith("of 6 runs · 0 … 3")
    page = begin_page(GraphPages(), drawn, "line.src")
    frame = "\n".join(text_frame(page, 40, 14).lines)
    assert re.search(r"^ *0┤.*^ *1┤.*^ *0 +1 +2\b.*a vs\. b", frame, re.MULTILINE | re.DOTALL)
    axes, bar = draw(page).axes
    assert [label.get_text() for label in axes.get_xticklabels()] == ["0", "1", "2"]
    assert (axes.get_ylabel(), bar.get_ylim()) == ("a", pytest.approx((0, 3)))


def test_the_sides_of_a_large_map_have_as_many_labels_as_have_room():
    assert cell_ticks(tuple(range(10)), 4) == ((0, "0"), (3, "3"), (6, "6"), (9, "9"))
    assert cell_ticks((1.0, 100.0), 1) == ((0, "1"),)


def test_a_scatter_has_a_point_for_each_run():
    drawn = chart(results("--over a=0:1:2 --over b=0:2:3 --keep x[end]"), "scatter", "b")
    points = sorted((round(x), round(y, 9)) for x, y in zip(drawn.x, drawn.lines[0].y, strict=True))
    assert points == [(0, 0), (0, 1), (1, 1), (1, 2), (2, 2), (2, 3)]


@pytest.mark.parametrize(
    ("options", "kind", "parameter", "told"),
    [
        ("--over a=1:3:3 --keep x[end]", "fan", "", "x[end] is one number of a run"),
        ("--over a=1:3:3 --keep x[end]", "map", "", "a map needs a grid over two quantities"),
        ("--over a=1:3:3 --keep x[end]", "scatter", "c", "'c' does not vary; what does: a"),
        ("--over a=1:3:3 --over b=1:3:3 --keep x[end]", "over", "", "2 quantities vary over a grid"),
        ("--over a=1:3:3 --keep x@0:1:0.5", "curves", "b", "'b' does not vary; what does: a"),
        ("--over a=1:3:3 --keep x@0:1:0.5", "histogram", "", "x@0:1:0.5 is a curve of each run"),
    ],
)
def test_what_cannot_be_drawn_is_said(options, kind, parameter, told):
    assert told in chart(results(options), kind, parameter)


@pytest.mark.parametrize(
    ("options", "kind"),
    [
        ("--over a=1:3:3 --keep x[end]", "over"),
        ("--over a=1:3:3 --over b=1:3:3 --keep x[end]", "map"),
        ("--sample a=normal(1,2) --runs 9 --keep x[end]", "histogram"),
        ("--sample a=normal(1,2) --runs 9 --keep x@0:1:0.5", "fan"),
        ("--over a=1:3:3 --keep x@0:1:0.5", "curves"),
    ],
)
def test_the_chart_that_says_most_comes_by_itself(options, kind):
    study = planned(Source(LINE, "line.src"), typed_options(options))
    assert usual_kind(study.plan, layouts(study.plan)[0]) == kind


@pytest.mark.parametrize("kind", CHART_KINDS)
def test_every_chart_has_a_page_before_the_first_run_and_after_the_last(kind):
    options = "--over a=1:3:3 --over b=1:3:3 --keep " if kind == "map" else "--over a=1:3:3 --keep "
    options += "x@0:1:0.5" if kind in ("fan", "curves") else "x[end]"
    after = results(options)
    before = Results(after.plan, after.layout, np.full_like(after.numbers, np.nan))
    pages = GraphPages()
    page = begin_page(pages, chart(before, kind), "line.src")
    assert page.title().endswith(f" of 0/{before.plan.runs} runs"), "no range of numbers that are not there"
    update_page(page, chart(after, kind))
    assert len(pages) == 1
    if kind == "map":
        assert page.shown[0].latest().max() == 1
    else:
        x, y = page.curves[-1].samples()
        assert len(x)
        assert page.frame.left <= np.nanmin(x)
        assert page.frame.right >= np.nanmax(x)
        assert page.frame.bottom <= np.nanmin(y)
        assert page.frame.top >= np.nanmax(y)


def test_runs_that_failed_are_left_out():
    whole = results("--over a=1:4:4 --keep x[end]")
    numbers = whole.numbers.copy()
    numbers[1] = np.nan
    drawn = chart(Results(whole.plan, whole.layout, numbers), "cumulated")
    assert isinstance(drawn, Chart)
    assert drawn.x == pytest.approx([1, 1, 3, 3, 4, 4])
    assert "3/4 runs" in drawn.title
