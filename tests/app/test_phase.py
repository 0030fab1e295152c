"""A phase plane on the desktop: it follows sliders, and orbits begin at clicks and typed places."""

from __future__ import annotations

import numpy as np

from .conftest import desktop

COMPETITION = """a = 1.5 | x = 0.4 | y = 0.3 | TMAX = 5 | DT = 0.01 | NN = 101
drun
DYNAMIC
d/dt x = x*(1 - x - a*y)
d/dt y = y*(1 - y - a*x)
dispxy x, y
"""


async def test_sliders_and_clicks(program):
    async with desktop(program(COMPETITION, "two.src")) as desk:
        app = desk.app
        await desk.line("orbit 0.5, 1")
        assert "Orbits begin in a phase plane" in desk.output
        await desk.press("f5")
        await desk.until(lambda: app.session.runs and not app.engine.is_busy)
        await desk.line("live a")
        await desk.line("phase in x = [0, 1.5], y = [0, 1.5] without basins")
        await desk.until(lambda: not app.analyses.is_going)
        assert app.live_page.is_shown
        page, runs = app.graph.page, len(app.session.runs)
        assert page.heading == "Phase plane of x and y"
        assert "saddle" in desk.output

        def nullcline():
            curve = next(c for c in page.curves if c.name == "x stands still")
            x, y = curve.samples()
            return x[np.isfinite(x) & (x > 0.1)], y[np.isfinite(x) & (x > 0.1)]

        (slider,) = app.graph.sliders.shown
        slider.focus()
        await desk.press("right")
        await desk.until(lambda: app.live_page.drawn == 1)
        x, y = nullcline()
        assert slider.value != 1.5
        assert np.allclose(x + slider.value * y, 1.0)
        assert len(app.session.runs) == runs, "the plane is drawn anew, nothing is run"

        before = len(page.curves)
        await desk.line("orbit 1.2, 0.1")
        await desk.until(lambda: len(page.curves) == before + 1)
        await desk.line("orbit 1.2")
        assert "',' is expected" in desk.output

        app.graph.post_message(app.graph.Pointed(0.5, 0.5))
        await desk.until(lambda: app.live_page.drawn == 3)
        starts = [(c.samples()[0][0], c.samples()[1][0]) for c in page.curves if c.count]
        assert any(np.allclose(place, (1.2, 0.1)) for place in starts)


async def test_a_click_points_at_a_place_of_the_frame(program):
    async with desktop(program(COMPETITION, "two.src")) as desk:
        await desk.press("f5")
        await desk.until(lambda: desk.app.session.runs and not desk.app.engine.is_busy)
        graph = desk.app.graph
        await desk.until(lambda: graph.canvas is not None and graph.frame is not None)
        columns, rows = graph.canvas.columns, graph.canvas.rows
        offset = (graph.frame.left + columns // 4, graph.frame.top + rows // 4)
        told = []
        post = graph.post_message
        graph.post_message = lambda message: (told.append(message), post(message))[1]
        await desk.pilot.click("#graph", offset=offset)
        (place,) = [m for m in told if isinstance(m, graph.Pointed)]
        assert abs(place.x - (columns // 4 + 0.5) / columns) < 1.5 / columns
        assert abs(place.y - (1 - (rows // 4 + 0.5) / rows)) < 1.5 / rows


async def test_c_on_a_slider_continues_over_its_range(program):
    text = "k = 1 | x = 1 | TMAX = 5 | DT = 0.01 | NN = 51\ndrun\nDYNAMIC\nd/dt x = k - x\ndispt x\n"
    async with desktop(program(text, "one.src")) as desk:
        app = desk.app
        app.do("analysis.over")
        await desk.until(lambda: any("No parameter has a slider" in n.message for n in app._notifications))
        await desk.press("f5")
        await desk.until(lambda: app.session.runs and not app.engine.is_busy)
        await desk.line("live k")
        (slider,) = app.graph.sliders.shown
        slider.focus()
        await desk.press("c")
        await desk.until(lambda: app.analyses.result is not None)
        assert app.analyses.result.title == "k continued, one.src"
        (branch,) = app.analyses.result["branches"]
        assert (branch["k"][0], branch["k"][-1]) == (slider.scale.low, slider.scale.high)
        assert app.graph.page.heading == "x over k"
