"""A former curve that stands behind those of a moving slider is drawn once, and looks as if it were drawn each time."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from desire_tui.engine.graph.axes import Axes
from desire_tui.engine.graph.colors import GHOST
from desire_tui.engine.outputs.braille_canvas import Canvas
from desire_tui.engine.outputs.incremental_drawing import Painter
from tests.graph.graphing import page_of

T = np.linspace(0, 1, 400)
WINDOW = (0.0, 1.0, 0.0, 1.0)


def page(factor):
    return page_of("dispt", T, {"x": factor * np.sin(20 * T), "y": np.cos(9 * T)})


@pytest.fixture
def ghost():
    return [replace(curve, color=GHOST) for curve in page(1.4).curves]


def over(ghost, factor):
    own = page(factor)
    return replace(own, curves=[*ghost, *own.curves])


class CountingCanvas(Canvas):
    lines = 0

    def line(self, *args, **options):
        self.lines += 1
        return super().line(*args, **options)


def drawn(graph, window=WINDOW, backdrop=None, size=(40, 12)):
    canvas = CountingCanvas(*size)
    painter = Painter(canvas, graph, window, 2, backdrop)
    painter.update()
    return canvas, painter


def same(one, other):
    return (
        (one[0].patterns == other[0].patterns).all()
        and (one[0].colors == other[0].colors).all()
        and one[1].clipped.counts() == other[1].clipped.counts()
    )


def test_it_is_drawn_once_and_looks_the_same(ghost):
    backdrop = drawn(over(ghost, 0.5))[1].backdrop
    assert backdrop is not None
    for factor in (0.7, 1.2):
        again = drawn(over(ghost, factor), backdrop=backdrop)
        assert again[0].lines == 2  # the page's own
        assert again[1].backdrop is backdrop
        alone = drawn(over(ghost, factor))
        assert alone[0].lines == 4
        assert same(again, alone)
        assert sum(again[1].clipped.counts()) > 0


def test_what_would_look_otherwise_is_drawn_anew(ghost):
    backdrop = drawn(over(ghost, 0.5))[1].backdrop
    others = [replace(curve, color=GHOST) for curve in page(0.2).curves]
    equal = over(ghost, 0.5)
    equal.set_axes(Axes(equal=True))
    for graph, options in (
        (over(ghost, 0.5), {"window": (0.0, 0.5, 0.0, 1.0)}),
        (over(ghost, 0.5), {"size": (50, 12)}),
        (over(others, 0.5), {}),
        (equal, {}),
    ):
        again = drawn(graph, backdrop=backdrop, **options)
        assert again[0].lines == 4
        assert same(again, drawn(graph, **options))


def test_a_former_run_that_goes_on_is_no_backdrop_yet(ghost):
    backdrop = drawn(over(ghost, 0.5))[1].backdrop
    for curve in ghost:
        curve.record.count = 200
    shorter = drawn(over(ghost, 0.5))[1].backdrop
    for curve in ghost:
        curve.record.count = 400
    graph = over(ghost, 0.5)
    assert drawn(graph, backdrop=backdrop)[0].lines == 2
    assert drawn(graph, backdrop=shorter)[0].lines == 4
