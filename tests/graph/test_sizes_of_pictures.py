"""`SHOW *`: pictures whose elements are squares as large as their values, until `SHOW` says colours again."""

from __future__ import annotations

import numpy as np

from desire_tui.engine.graph.pages import GraphPages
from desire_tui.engine.outputs.braille_canvas import Canvas
from desire_tui.engine.outputs.incremental_drawing import Painter
from desire_tui.engine.source import Source
from tests.graph.test_picture_files import pixels
from tests.graph.test_text_canvas import lit
from tests.runtime.running import session_for

VALUES = np.array([1.0, 0.25, -1.0, 0.0])


def shown(values=VALUES, columns=4, scale=1.0):
    pages = GraphPages()
    pages.show("A", np.asarray(values, dtype=float), columns, scale, by_size=True)
    return pages.current


def dots_of(page, columns, rows):
    canvas = Canvas(columns, rows)
    Painter(canvas, page).update()
    return canvas, lit(canvas)


def test_the_area_of_a_square_is_the_magnitude_in_the_terminal():
    _, dots = dots_of(shown(), 40, 5)  # cells of 20 by 20 dots
    area = [sum(20 * k <= column < 20 * k + 20 for column, _ in dots) for k in range(4)]
    assert 0.7 * 400 < area[0] < 400
    assert abs(area[1] / area[0] - 0.25) < 0.08
    assert abs(area[2] - area[0]) < 0.15 * area[0]  # the last column of a picture stays free
    assert area[3] == 0


def test_a_curve_on_the_same_graph_is_drawn_over_each_new_picture():
    session = session_for(
        "TMAX = 1 | DT = 0.1 | NN = 11 | ARRAY A[2]\ndrun\nDYNAMIC\nd/dt x = 1\nA[1] = t\nSHOW A\ndispt x\n"
    )
    graph = session.graphs.current
    assert graph.curves
    assert graph.shown
    both, alone = Canvas(40, 10), Canvas(40, 10)
    Painter(both, graph).update()
    graph.shown[:] = []
    Painter(alone, graph).update()
    assert lit(alone) <= lit(both)


def test_the_sign_is_the_colour_and_a_value_above_scale_is_a_full_square():
    canvas, dots = dots_of(shown([7.0, -7.0], 2), 20, 5)
    assert {canvas.colors[10 // 4, 5], canvas.colors[10 // 4, 15]} == {14, 9}
    assert {row for _, row in dots} == set(range(1, 19))


def test_a_small_value_is_a_dot_and_nan_nothing():
    _, dots = dots_of(shown([1e-9, np.nan, np.inf], 3), 30, 5)
    assert len({column for column, _ in dots if column < 20}) in (1, 2)
    assert not any(20 <= column < 39 for column, _ in dots)


def test_squares_in_a_picture_file(tmp_path):
    image = pixels(shown([1.0, 0.25, -1.0, -0.25], 4), tmp_path)
    grey = np.abs(image - 128).max(axis=2) <= 2
    rows = np.flatnonzero(grey.mean(axis=1) > 0.1)  # the title above it has grey edges
    columns = np.flatnonzero(grey.mean(axis=0) > 0.05)
    inside = image[rows.min() : rows.max() + 1, columns.min() : columns.max() + 1]
    quarters = np.array_split(inside, 4, axis=1)
    white = [float((part >= 250).all(axis=2).mean()) for part in quarters]
    black = [float((part <= 5).all(axis=2).mean()) for part in quarters]
    assert np.allclose(white, [0.81, 0.2025, 0, 0], atol=0.03)
    assert np.allclose(black, [0, 0, 0.81, 0.2025], atol=0.03)


def sizes(text):
    return [picture.by_size for page in session_for(text).graphs for picture in page.shown]


def test_the_script_says_which_until_it_says_otherwise():
    assert sizes("ARRAY A[4]\nSHOW A | SHOW * | SHOW A | SHOW A, 2 | SHOW | SHOW A\n") == [
        False, True, True, False,
    ]  # fmt: skip


def test_a_segment_follows_the_script_unless_it_says_itself():
    program = "ARRAY A[4], B[4]\nNN = 2\n{script}\ndrun\nDYNAMIC\n{segment}\n"
    assert sizes(program.format(script="SHOW *", segment="SHOW A | SHOW B")) == [True, True]
    assert sizes(program.format(script="SHOW *", segment="SHOW | SHOW A | SHOW * | SHOW B")) == [False, True]
    assert sizes(program.format(script="", segment="SHOW A\nSHOW *\nSHOW B")) == [False, True]
    assert sizes(program.format(script="SHOW * | drun | SHOW", segment="SHOW A")) == [True, False]


def test_erun_begins_with_colours():
    session = session_for("ARRAY A[4]\nSHOW *\nSHOW A\n")
    session.erun(Source("ARRAY A[4]\nSHOW A\n", "b.src"))
    assert [page.shown[0].by_size for page in session.graphs] == [True, False]
