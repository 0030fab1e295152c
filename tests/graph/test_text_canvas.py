"""Braille canvas, painter and frame."""

from __future__ import annotations

import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from desire_tui.engine.graph.pages import GraphPages
from desire_tui.engine.graph.ticks import tick_label
from desire_tui.engine.outputs.braille_canvas import NO_COLOR, TILE_COLUMNS, Canvas
from desire_tui.engine.outputs.incremental_drawing import Painter
from desire_tui.engine.outputs.text_frame import text_frame
from desire_tui.engine.outputs.text_plot import text_plot
from tests.graph.graphing import displayed, page_of, record_of


def lit(canvas):
    """Return all dots as (column, row) from the upper left, by the braille standard's own numbering."""
    places = {0: (0, 0), 1: (0, 1), 2: (0, 2), 3: (1, 0), 4: (1, 1), 5: (1, 2), 6: (0, 3), 7: (1, 3)}
    dots = set()
    for row in range(canvas.rows):
        for column, character in enumerate(canvas.text(row)):
            pattern = ord(character) - 0x2800 if character != " " else 0
            dots |= {
                (2 * column + places[b][0], 4 * row + places[b][1]) for b in range(8) if pattern >> b & 1
            }
    return dots


def one(*values):
    return np.array(values, dtype=float)


def test_corners():
    canvas = Canvas(3, 2)
    canvas.dots(one(0, 1, 0, 1), one(0, 0, 1, 1), 14)
    assert lit(canvas) == {(0, 0), (5, 0), (0, 7), (5, 7)}
    assert canvas.text(0) == "⠁ ⠈"
    assert canvas.text(1) == "⡀ ⢀"


def test_a_diagonal_has_a_dot_in_each_column():
    canvas = Canvas(4, 2)
    canvas.line(one(0, 1), one(1, 0), 9)
    assert lit(canvas) == {(k, k) for k in range(8)}


def test_outside_and_undefined_draw_nothing():
    canvas = Canvas(5, 5)
    canvas.dots(one(-0.01, 1.01, 0.5, np.nan, np.inf), one(0.5, 0.5, 1.2, 0.5, 0.5), 9)
    canvas.line(one(0.1, np.nan, 0.3), one(0.5, 0.5, 0.5), 9)
    canvas.line(one(-2, -1), one(0, 1), 9)
    assert lit(canvas) == set()
    assert (canvas.colors == NO_COLOR).all()
    canvas.line(one(-1e300, 1e300), one(0.5, 0.5), 9)
    assert {column for column, _ in lit(canvas)} == set(range(10))


@settings(max_examples=60)
@given(st.lists(st.tuples(st.floats(-1, 2), st.floats(-1, 2)), min_size=2, max_size=20))
def test_lines_are_connected_and_pass_their_inner_points(points):
    canvas = Canvas(20, 10)
    x, y = np.array(points).T
    canvas.line(x, y, 12)
    dots = lit(canvas)
    for px, py in points:
        if 0 < px < 1 and 0 < py < 1:
            column, row = int(px * 40), int((1 - py) * 40)
            assert any((column + dx, row + dy) in dots for dx in (-1, 0, 1) for dy in (-1, 0, 1))


def test_the_last_colour_of_a_cell_counts():
    canvas = Canvas(2, 1)
    canvas.dots(one(0.1), one(0.9), 10)
    canvas.dots(one(0.1), one(0.1), 12)
    assert canvas.colors.tolist() == [[12, NO_COLOR]]
    assert canvas.runs(0) == [("⡁", 12), (" ", NO_COLOR)]


def test_only_changed_tiles_are_dirty():
    canvas = Canvas(40, 4)
    canvas.take_dirty()
    canvas.dots(one(0.5), one(0.99), 9)
    assert canvas.take_dirty() == {(0, 20 // TILE_COLUMNS)}
    canvas.dots(one(0.5), one(0.99), 9)  # the same dot in the same colour
    assert canvas.take_dirty() == set()
    canvas.dots(one(0.5), one(0.99), 10)
    assert canvas.take_dirty() == {(0, 20 // TILE_COLUMNS)}
    canvas.clear()
    assert len(canvas.take_dirty()) == 4 * 5


def test_painting_bit_by_bit_gives_what_painting_at_once_gives():
    t = np.linspace(0, 1, 5000)
    data = {"x": np.sin(40 * t), "y": np.where(t > 0.5, np.nan, np.cos(30 * t))}
    whole = page_of("dispt", t, data)
    at_once = Canvas(60, 20)
    Painter(at_once, whole).update()
    record = record_of("dispt", t, data)
    record.count = 0
    growing = GraphPages().begin_run(record)
    bits = Canvas(60, 20)
    painter = Painter(bits, growing)
    for count in range(0, 5001, 125):
        record.count = count
        painter.update()
    different = at_once.patterns != bits.patterns
    # a line drawn in two pieces may turn half a dot earlier or later: one dot in hundreds
    assert different.mean() < 0.02


def test_no_peak_is_lost():
    t = np.linspace(0, 1, 100_000)
    x = np.zeros_like(t)
    x[70_007] = 0.95
    canvas = Canvas(40, 10)
    Painter(canvas, page_of("dispt", t, {"x": x})).update()
    assert canvas.patterns[0].any()


def test_a_window_zooms():
    t = np.linspace(0, 1, 1000)
    page = page_of("dispt", t, {"x": t})
    canvas = Canvas(10, 10)
    Painter(canvas, page, (0.5, 1.0, 0.75, 1.0)).update()
    # x = t; the window shows t from 1/2 to 1 and x from 1/2 to 1: its diagonal
    dots = lit(canvas)
    assert (0, 39) in dots
    assert (19, 0) in dots


def test_few_points_are_crosses_and_many_are_dots():
    t = np.arange(500.0)
    record = record_of("dispxy", t, {"x": t / 250 - 1, "y": np.sin(t / 20)}, rule=0)
    record.count = 5
    canvas = Canvas(100, 30)
    painter = Painter(canvas, GraphPages().begin_run(record))
    painter.update()
    assert len(lit(canvas)) > 3 * 5
    record.count = 500
    painter.update()
    at_once = Canvas(100, 30)
    Painter(at_once, painter.graph).update()
    assert lit(canvas) == lit(at_once)
    assert len(lit(canvas)) <= 500


def test_erasing_empties_the_canvas():
    pages = GraphPages()
    page = pages.begin_run(record_of("dispt", np.linspace(0, 1, 50), {"x": np.zeros(50)}))
    canvas = Canvas(10, 4)
    painter = Painter(canvas, page)
    painter.update()
    assert lit(canvas)
    displayed(pages, "F")
    painter.update()
    assert not lit(canvas)


def test_interpreter_points_have_their_colours():
    pages = GraphPages()
    displayed(pages, "A")
    pages.plot(-0.9, 0.9, 12, 1.0)
    pages.plot(0.9, -0.9, 10, 1.0)
    canvas = Canvas(10, 4)
    Painter(canvas, pages.current).update()
    assert {int(c) for c in np.unique(canvas.colors)} == {10, 12, NO_COLOR}


def test_pictures_are_dense_where_values_are_large():
    pages = GraphPages()
    values = np.concatenate([np.zeros(32), np.full(32, 0.9)])
    pages.show("A", values, 8, 1.0)
    canvas = Canvas(20, 8)
    Painter(canvas, pages.current).update()
    dots = lit(canvas)
    upper = sum(row < 16 for _, row in dots)
    assert upper == 0
    assert len(dots) > 0.8 * 40 * 16


def test_drawing_calls_nothing_for_each_sample():
    """Ten thousand samples of twelve curves are drawn by NumPy: as many calls as for a thousand, or nearly."""

    def calls(samples):
        t = np.linspace(0, 1, samples)
        page = page_of("dispt", t, {f"x{k}": np.sin((k + 1) * 20 * t) for k in range(12)})
        painter = Painter(Canvas(100, 30), page)
        count = 0

        def counted(_frame, event, _argument):
            nonlocal count
            count += event in {"call", "c_call"}

        sys.setprofile(counted)
        try:
            painter.update()
        finally:
            sys.setprofile(None)
        return count

    calls(100)  # imports and first-use work
    assert calls(10_000) < 1.5 * calls(1_000) + 100


@pytest.mark.parametrize(("columns", "rows"), [(80, 24), (40, 10), (160, 50), (5, 2)])
def test_the_frame_has_its_hole_where_it_says(columns, rows):
    frame = text_frame(page_of("dispt", [0, 0.5], {"x": np.zeros(2)}, scale=2.0), columns, rows)
    text = "\n".join(frame.lines)
    assert "scale = 2" in text
    assert "x vs. t" in text
    for row in range(frame.top, frame.top + frame.rows):
        assert frame.lines[row][frame.left : frame.left + frame.columns].strip() == ""
        assert frame.lines[row][frame.left - 1] in "│┤├"
        assert frame.lines[row][frame.left + frame.columns] == "│"
    assert frame.lines[frame.top - 1][frame.left - 1] == "┌"
    assert frame.lines[frame.top + frame.rows][frame.left + frame.columns] == "┘"


def test_a_graph_without_net_has_no_frame_lines():
    frame = text_frame(page_of("dispt", [0, 1], {"x": np.zeros(2)}, "C16"), 60, 20)
    assert not set("┌┐└┘│┤┬─") & set("".join(frame.lines))
    assert frame.columns > 40
    assert frame.rows > 10


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (-0.0, "0"),
        (0.25, "0.25"),
        (1e-7, "1e-7"),
        (3e8, "3e8"),
        (123456, "1.2346e5"),
        (-1.5, "-1.5"),
    ],
)
def test_tick_labels_are_short(value, text):
    assert tick_label(value) == text


def test_text_plot_survives_everything(tmp_path):
    t = np.linspace(0, 1, 100)
    wild = {"x": np.where(t > 0.5, np.inf, t), "y": np.full(100, np.nan), "z": 1e300 * t}
    text = text_plot(page_of("dispt", t, wild), 80, 24, colored=True)
    assert "x, y, z vs. t" in text
    assert "\x1b[38;2;255;255;85m" in text  # yellow, colour 14


def test_white_graphs_are_white_all_over_on_a_terminal():
    text = text_plot(page_of("dispt", [0, 1], {"x": np.zeros(2)}, "N-10"), 40, 12, colored=True)
    rows = [line for line in text.split("\n") if "│" in line]
    assert len(rows) > 5
    assert all("\x1b[48;2;255;255;255m" in line for line in rows)


def test_pictures_as_text():
    pages = GraphPages()
    pages.show("A", np.linspace(-1, 1, 16), 4, 1.0)
    text = text_plot(pages.current, 40, 14, colored=False)
    assert "scale = 1" in text
    assert "A" in text
    assert sum(0x2800 < ord(c) <= 0x28FF for c in text) > 20
