"""Logarithmic axes, equal scales, dashes of curves beyond the colours, minor ticks."""

from __future__ import annotations

import numpy as np
import pytest

from desire_tui.engine.graph.axes import Axes, equalized
from desire_tui.engine.graph.fit import Extent, limits
from desire_tui.engine.graph.pages import GraphPages
from desire_tui.engine.graph.ticks import log_limits, log_ticks, minor_log_ticks
from desire_tui.engine.graph.units import units_of, with_units
from desire_tui.engine.outputs.braille_canvas import Canvas
from desire_tui.engine.outputs.incremental_drawing import Painter
from desire_tui.engine.outputs.matplotlib_figure import draw
from desire_tui.engine.outputs.text_frame import equal_view, text_frame
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source
from tests.graph.graphing import page_of, record_of

T = np.linspace(0.0, 10.0, 101)


def page(data, *words, kind="dispt"):
    pages = GraphPages()
    for word in words:
        pages.display(word, [], 1.0)
    return pages.begin_run(record_of(kind, T, data))


def test_an_exponential_is_a_straight_line_on_a_log_axis_from_power_to_power():
    graph = page({"x": 100 * np.exp(-T), "y": -T}, "logy")  # y has no logarithm anywhere
    extent = Extent(graph)
    extent.update()
    assert extent.is_fitted
    view = extent.view()
    assert limits(graph, view) == pytest.approx((0, 10, -3, 2))
    canvas = Canvas(40, 20)
    Painter(canvas, graph, view).update()
    rows, columns = np.nonzero(canvas.patterns)
    assert np.abs(np.corrcoef(rows, columns)[0, 1]) > 0.99
    frame = text_frame(graph, 60, 20, view)
    assert [label in "\n".join(frame.lines) for label in ("100┤", "1┤", "0.001┤")] == [True] * 3


def test_both_axes_logarithmic_in_a_picture():
    with np.errstate(divide="ignore"):
        axes = draw(page({"x": T**2, "y": T**-1.0}, "loglog")).axes[0]
    assert axes.get_xlim() == pytest.approx((-1, 1))
    assert axes.get_ylim() == pytest.approx((-2, 2))
    assert [text.get_text() for text in axes.get_xticklabels()] == ["0.1", "1", "10"]
    assert len(axes.get_xticks(minor=True)) == 16


def test_ticks_of_log_axes():
    assert log_ticks(-3.0, 2.0)[1] == ("0.001", "0.01", "0.1", "1", "10", "100")
    assert log_ticks(-20.0, 20.0, 5)[1] == ("1e-18", "1e-9", "1", "1e9", "1e18")
    assert log_ticks(0.0, 1.0)[1] == ("1", "2", "5", "10")
    assert log_ticks(np.log10(3.1), np.log10(3.9))[1] == ("3.2", "3.4", "3.6", "3.8")
    assert log_ticks(1.0, 1.0) == ((), ())
    assert log_limits(-2.3, 1.7) == (-3, 2)
    assert log_limits(np.log10(3.1), np.log10(3.9)) == pytest.approx((np.log10(3), np.log10(4)))
    assert minor_log_ticks(0.0, 1.0, 40) == pytest.approx(np.log10(range(2, 10)))
    assert minor_log_ticks(-10.0, 10.0, 40) == pytest.approx(range(-10, 11))


def test_circles_are_round():
    graph = page({"x": np.cos(T), "y": np.sin(T)}, "equal", kind="dispxy")
    view = equal_view(graph, 100, 20, (0.0, 1.0, 0.0, 1.0))
    frame = text_frame(graph, 100, 20, view)
    canvas = Canvas(frame.columns, frame.rows)
    Painter(canvas, graph, view).update()
    rows, columns = np.nonzero(canvas.patterns)
    assert np.ptp(columns) == pytest.approx(2 * np.ptp(rows), abs=3)
    assert draw(graph).axes[0].get_box_aspect() == 1.0
    assert equalized(graph.frame, (0, 1, 0, 1), 0.5) == (0, 1, -0.5, 1.5)


def test_words_of_display():
    session = Session(backend="reference")
    program = "TMAX = 1 | DT = 0.1 | NN = 3 | x = 1\n{} drun\nDYNAMIC\nd/dt x = -x\ndispt x\n"
    for script, expected in (
        ("display logy |", Axes(log_y=True)), ("display logx | display equal |", Axes(log_x=True, equal=True)),
        ("display loglog | display linear |", Axes()), ("", Axes()),
    ):  # fmt: skip
        session.erun(Source(program.format(script)))
        assert session.graph.axes == expected
    session.execute("display logy")
    assert session.graph.axes == Axes(log_y=True)


def test_more_curves_than_colours_are_dashed():
    many = page_of("dispt", T, {f"x{n}": 0 * T + n / 20 for n in range(16)})
    assert [curve.dash for curve in many.curves] == [0] * 7 + [1] * 7 + [2] * 2
    assert [key.sign for key in many.keys] == ["■"] * 7 + ["╍"] * 7 + ["┉"] * 2
    canvas = Canvas(80, 40)
    Painter(canvas, many).update()
    lit = [np.count_nonzero(canvas.colors == curve.color) for curve in many.curves]
    assert lit[2] > 80  # two curves of this colour: one in all columns, the other in some
    lines = draw(many).axes[0].lines
    assert [line.get_linestyle() for line in (lines[0], lines[7])] == ["-", "--"]
    assert page_of("dispt", T, {f"x{n}": T for n in range(8)}, "N18").curves[7].dash == 0


@pytest.mark.parametrize("dash", [1, 2, 3])
def test_dashes_do_not_depend_on_when_they_were_drawn(dash: int):
    x, y = np.linspace(0, 1, 200), np.linspace(0, 1, 200) ** 2
    whole, grown = Canvas(40, 20), Canvas(40, 20)
    whole.line(x, y, 9, dash=dash)
    along = 0
    for start in range(0, 200, 10):
        along = grown.line(
            x[max(start - 1, 0) : start + 10], y[max(start - 1, 0) : start + 10], 9, 1, dash, along
        )
    assert np.array_equal(whole.patterns, grown.patterns)
    full = Canvas(40, 20)
    full.line(x, y, 9)
    assert 0 < np.bitwise_count(whole.patterns).sum() < np.bitwise_count(full.patterns).sum()


@pytest.mark.parametrize(
    ("text", "label"),
    [
        ("x m, t s", "x [m], y vs. t [s]"), ("x m, y = m", "x, y [m] vs. t"), ("v m/s", "x, y vs. t"),
        ("x: kg m, y 1/s, t", "x [kg m], y [1/s] vs. t"), ("", "x, y vs. t"),
    ],
)  # fmt: skip
def test_units_stand_at_the_axes(text, label):
    graph = page({"x": T, "y": T})
    graph.texts["units"] = text
    assert graph.label == label
    graph.texts["ylabel"] = "own"
    assert graph.label.startswith("own vs. t")


def test_units_of_elements():
    assert with_units("A[1,2], B", {"A[1,2]": "m"}) == "A[1,2] [m], B"
    assert units_of("A[1,2] m, b s") == {"A[1,2]": "m", "b": "s"}


def test_minor_ticks_point_to_the_inside():
    frame = text_frame(page({"x": T / 10}), 80, 24)
    bottom = frame.lines[frame.top + frame.rows]
    assert bottom.count("┬") == 6
    assert bottom.count("┴") == 5
