"""Live mode: sliders below the graph that belong to their program and agree with its runs."""

from __future__ import annotations

import math

import pytest

from desire_tui.engine.graph.colors import GHOST
from desire_tui.engine.graph.fit import limits
from desire_tui.panes.parameter_list import ParameterList
from desire_tui.panes.slider_scale import SliderScale

from .conftest import OSCILLATOR, Desktop, desktop

DAMPED = """\
-- damped oscillator
TMAX = 6 | DT = 0.01 | NN = 61
g = 8 | c = 0.1 -- damping
ARRAY q[2] | q[2] = 0.5
w = g/2
x = 1
drun
DYNAMIC
d/dt x = v
d/dt v = -w*x - c*v + q[2]
dispt x, v
"""


async def settled(desk: Desktop) -> None:
    await desk.until(lambda: not desk.app.engine.is_busy and desk.app.live_mode._wanted is None)
    await desk.pilot.pause()


async def test_parameters_are_chosen_from_a_list_and_agree_with_the_runs(program):
    async with desktop(program(DAMPED, "damped.src"), size=(120, 40)) as desk:
        app = desk.app
        await desk.press("alt+l")
        assert not app.graph.sliders.shown  # nothing has run
        await desk.press("f5")
        await desk.idle()
        await desk.press("alt+l")
        await desk.pilot.pause()
        assert isinstance(app.screen, ParameterList)
        rows = [app.screen._list.get_option_at_index(n).value for n in range(app.screen._list.option_count)]
        assert rows == ["g", "c", "q[2]", "w", "x(0)", "v(0)"]
        await desk.press("down", "space", "down", "down", "down", "space")  # c and x(0)
        boxes = [app.screen._list.render_line(y).text[:3] for y in range(6)]
        assert boxes == ["[ ]", "[x]", "[ ]", "[ ]", "[x]", "[ ]"]
        await desk.press("enter")
        await desk.pilot.pause()
        sliders = {slider.label: slider for slider in app.graph.sliders.shown}
        assert [(label, slider.value) for label, slider in sliders.items()] == [("c", 0.1), ("x(0)", 1.0)]
        before = app.graph.page
        sliders["c"].focus()
        await desk.press("shift+right")
        await settled(desk)
        started = app.session.runs[-1].start
        assert started.parameters["c"] == sliders["c"].value == 0.12
        assert started.initial["x"] == 1.0
        # the former curve is a ghost, paler than everything drawn after it
        app.graph.tick()
        assert app.graph.paging.ghost is before
        assert [curve.color for curve in app.graph._painter.graph.curves] == [GHOST, GHOST, 14, 15]
        await desk.do("graph.log")  # both on axes from power to power of ten
        values = [curve.samples()[1] for curve in (*before.curves, *app.graph.page.curves)]
        least = min(float(y[y > 0].min()) for y in values)
        bottom, top = limits(app.graph.page, app.graph.window)[2:]
        assert (bottom, top) == pytest.approx((math.floor(math.log10(least)), 1))
        await desk.do("graph.log", "linear")
        await desk.press("down", "right")
        await settled(desk)
        assert app.session.runs[-1].start.initial["x"] == sliders["x(0)"].value == 1.02
        # F5 runs the program's text: the sliders follow, and the ghost goes
        await desk.press("f5")
        await desk.idle()
        assert (sliders["c"].value, sliders["x(0)"].value) == (0.1, 1.0)
        app.graph.tick()
        assert app.graph.paging.ghost is None
        # so does Shift+F5
        sliders["c"].focus()
        await desk.press("right")
        await settled(desk)
        assert app.session.runs[-1].start.parameters["c"] == sliders["c"].value == 0.102
        await desk.press("shift+f5")
        await desk.idle()
        assert app.session.runs[-1].start.parameters["c"] == sliders["c"].value == 0.1
        # value and limits are typed
        sliders["c"].focus()
        await desk.press("enter")
        field = app.graph.sliders.query_one("#limits")
        assert field.has_focus
        assert field.value == "0.1 in 0 … 0.2"
        await desk.press("escape")
        assert not field.display
        assert sliders["c"].has_focus
        await desk.press("enter", "home", "0")  # no key of the graph's
        assert field.value.startswith("00.1 in")
        field.value = "0.4 in 0.2 … 2"
        await desk.press("enter")
        await settled(desk)
        assert sliders["c"].scale == SliderScale(0.2, 2.0)
        assert "0.2 ├" in sliders["c"].render_line(0).text
        assert app.session.runs[-1].start.parameters["c"] == 0.4
        assert sliders["c"].has_focus
        # what the sliders say is written into the program, and one undo takes it back
        await desk.do("run.live", "w")
        await desk.press("right")
        await settled(desk)
        await desk.do("run.live_write")
        text = app.editor.front.text
        assert text == DAMPED.replace("c = 0.1 ", "c = 0.4 ").replace("w = g/2", "w = 4.1")
        await desk.press("f5")
        await desk.idle()
        assert app.session.runs[-1].start.parameters == {"c": 0.4, "w": 4.1, "q[2]": 0.5}
        assert sliders["c"].value == 0.4
        app.editor.front.undo()
        assert app.editor.front.text == DAMPED
        # they belong to their program
        await desk.line(f"load '{program(OSCILLATOR)}'")
        await desk.press("f5")
        await desk.idle()
        assert not app.graph.sliders.display
        await desk.do("file.previous")
        await desk.press("f5")
        await desk.idle()
        assert [slider.label for slider in app.graph.sliders.shown] == ["c", "x(0)", "w"]
        sliders["x(0)"].focus()
        await desk.press("delete")
        assert [slider.label for slider in app.graph.sliders.shown] == ["c", "w"]
        await desk.press("escape")
        assert app.graph.has_focus


def test_scales():
    linear = SliderScale.around(0.1)
    assert linear == SliderScale(0.0, 0.2)
    assert [linear.part(value) for value in (-1, 0.05, 9)] == [0.0, 0.25, 1.0]
    assert linear.stepped(0.1, 1) == 0.102
    assert linear.at(0.5, 50) == 0.1
    assert linear.holding(0.3) == SliderScale(0.0, 0.3)
    log = linear.toggled(0.1)
    assert log == SliderScale(0.01, 0.2, is_log=True)
    assert log.stepped(0.1, 50) == 1.0
    assert SliderScale(0.01, 100, is_log=True).part(1.0) == pytest.approx(0.5)
    assert SliderScale(0.01, 100, is_log=True).at(0.5, 50) == 1.0
    assert log.toggled(0.1) == SliderScale(0.01, 0.2)
    assert SliderScale(-1, 1).toggled(-0.5) is None


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("0.3", (0.3, SliderScale(0.0, 0.3))),
        ("-1 1", (0.1, SliderScale(-1.0, 1.0))),
        ("2..4", (2.0, SliderScale(2.0, 4.0))),
        ("0.5 in 0 … 2", (0.5, SliderScale(0.0, 2.0))),
        ("a", None), ("", None), ("1 1", None), ("1 2 3 4", None), ("nan", None),
    ],
)  # fmt: skip
def test_values_and_limits_as_they_are_typed(text, expected):
    assert SliderScale(0.0, 0.2).typed(text, 0.1) == expected


def test_limits_of_a_log_range_are_above_0():
    assert SliderScale(0.01, 1.0, is_log=True).typed("0 2", 0.1) is None
