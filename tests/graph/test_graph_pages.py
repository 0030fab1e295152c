"""What display statements mean: language.md 13, book 1.3.7 and Table 1.1."""

from __future__ import annotations

import numpy as np
import pytest

from desire_tui.engine.graph.colors import BLACK, WHITE, rgb
from desire_tui.engine.graph.pages import GraphPages
from desire_tui.engine.graph.settings import DisplaySettings
from desire_tui.engine.lowered.segment import SampleColumn, SampleRequest
from tests.graph.graphing import PLACE, displayed, page_of, record_of

T = np.linspace(2.0, 5.0, 4)
FIVE = {name: np.zeros(4) for name in "abcde"}


def colors(*commands, data=FIVE):
    return [curve.color for curve in page_of("dispt", T, data, *commands).curves]


def test_curves_get_n_and_the_next_within_9_to_15():
    assert colors("N11") == [11, 12, 13, 14, 15]
    assert colors("N14") == [14, 15, 9, 10, 11]
    assert colors("N9") == [9, 10, 11, 12, 13]


def test_one_colour_graphs_are_white_on_black_and_black_on_white():
    assert colors("N16") == [WHITE] * 5
    assert colors("N18") == [WHITE] * 5
    assert colors("N-18") == [BLACK] * 5
    assert colors("N16", "C17") == [BLACK] * 5
    assert page_of("dispt", T, FIVE, "N-18").keys == ()
    assert len(page_of("dispt", T, FIVE, "N-14").keys) == 5


def test_negative_n_means_a_white_background():
    assert page_of("dispt", T, FIVE, "N-10").white
    assert not page_of("dispt", T, FIVE, "N10").white
    assert not page_of("dispt", T, FIVE, "N-10", "N10").white


def test_no_curve_is_invisible_on_white():
    for first in range(9, 16):
        for color in colors(f"N-{first}"):
            assert contrast(rgb(color, white=True), (255, 255, 255)) > 2.4, color


def contrast(a, b):
    """Contrast ratio of WCAG 2.1."""

    def luminance(color):
        parts = [
            (c / 255 / 12.92 if c / 255 <= 0.03928 else ((c / 255 + 0.055) / 1.055) ** 2.4) for c in color
        ]
        return 0.2126 * parts[0] + 0.7152 * parts[1] + 0.0722 * parts[2]

    light, dark = sorted((luminance(a), luminance(b)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


@pytest.mark.parametrize(
    ("commands", "net"),
    [
        (["C7"], 7), (["C16"], None), (["N-10", "C16"], BLACK), (["N-10", "C15"], None), (["C15"], 15),
        (["C17"], BLACK), (["N-10", "C7"], 7),
    ],
)  # fmt: skip
def test_the_net(commands, net):
    assert page_of("dispt", T, FIVE, *commands).net == net


def test_c17_makes_the_background_white():
    assert page_of("dispt", T, FIVE, "C17").white


def test_thickness():
    assert [page_of("dispt", T, FIVE, letter).curves[0].thickness for letter in "QRY"] == [1, 2, 3]


def test_the_frame_of_dispt_is_the_run():
    page = page_of("dispt", T, {"x": T, "y": T}, scale=4.0)
    frame = page.frame
    assert (frame.left, frame.right, frame.bottom, frame.top) == (2.0, 5.0, -4.0, 4.0)
    assert page.title() == "run 1 · scale = 4"
    assert page.caption == "x, y vs. t"


def test_dispxy_shows_later_variables_over_the_first():
    page = page_of("dispxy", T, {"x": T, "y": -T, "z": 2 * T}, scale=3.0)
    assert page.caption == "y, z vs. x"
    assert [(c.x_name, c.name) for c in page.curves] == [("x", "y"), ("x", "z")]
    x, y = page.curves[1].samples()
    assert (x.tolist(), y.tolist()) == (T.tolist(), (2 * T).tolist())
    assert (page.frame.left, page.frame.right) == (-3.0, 3.0)


def test_capital_dispxy_shows_pairs():
    page = page_of("DISPXY", T, {"a": T, "b": -T, "c": 2 * T, "d": 3 * T})
    assert [(c.x_name, c.name, c.color) for c in page.curves] == [("a", "b", 14), ("c", "d", 15)]
    assert page.caption == "b vs. a, d vs. c"


def test_a_listing_beside_the_graph_does_not_shift_its_columns():
    listing = SampleRequest("type", (SampleColumn("q", 3, PLACE),))
    pages = GraphPages()
    page = pages.begin_run(record_of("dispt", T, {"x": 5 * T}, more=(listing,)))
    assert page.curves[0].samples()[1].tolist() == (5 * T).tolist()


def test_display_0_1_2():
    pages = GraphPages()
    run = lambda: pages.begin_run(record_of("dispt", T, {"x": T}))  # noqa: E731
    first = run()
    assert run() is not first
    displayed(pages, "2")
    shared = run()
    assert run() is shared
    assert len(shared.curves) == 3  # onto the page of the run before it
    displayed(pages, "0")
    assert run() is None
    displayed(pages, "1")
    assert run() is not shared
    pages.begin_program()
    displayed(pages, "2")
    assert len(run().curves) == 1  # a program starts a page whatever `display` says


def test_curves_on_a_shared_page_keep_their_own_scale():
    pages = GraphPages()
    displayed(pages, "2")
    pages.begin_run(record_of("dispt", T, {"x": T}, scale=1.0))
    page = pages.begin_run(record_of("dispt", T + 3, {"x": T}, scale=10.0))
    assert [c.frame.top for c in page.curves] == [1.0, 10.0]
    assert page.frame.top == 10.0


def test_keys_name_each_curve_once():
    page = page_of("dispt", T, {"x": T, "y": T})
    assert [(k.name, k.color) for k in page.keys] == [("x", 14), ("y", 15)]


def test_erase_empties_the_page():
    pages = GraphPages()
    page = pages.begin_run(record_of("dispt", T, {"x": T}))
    assert pages.display("F", [], 1.0)
    assert page.is_empty
    assert page.erased == 1


def test_interpreter_plots():
    pages = GraphPages()
    displayed(pages, "A", scale=2.0)
    pages.plot(1.0, -1.0, 12, 2.0)
    pages.plot(0.5, 0.5, None, 2.0)
    page = pages.current
    assert (page.frame.left, page.frame.right) == (-2.0, 2.0)
    x, y, c = page.points.so_far()
    assert (x.tolist(), y.tolist(), c.tolist()) == ([1.0, 0.5], [-1.0, 0.5], [12, 14])
    displayed(pages, "B", scale=2.0)
    assert (pages.current.frame.left, pages.current.frame.bottom) == (0.0, -2.0)
    for k in range(1000):
        pages.plot(k / 1000, 0.0, 9, 2.0)
    assert pages.current.points.count == 1000
    assert pages.current.points.so_far()[0][999] == 0.999


def test_maps_are_dots_and_solutions_are_lines():
    assert not page_of("dispxy", T, {"x": T, "y": T}, rule=0).curves[0].joined
    assert page_of("dispxy", T, {"x": T, "y": T}, rule=1).curves[0].joined
    assert page_of("dispt", T, {"x": T}, rule=0).curves[0].joined


def test_curves_grow_with_their_record():
    record = record_of("dispt", np.arange(10.0), {"x": np.arange(10.0)})
    record.count = 3
    curve = GraphPages().begin_run(record).curves[0]
    assert curve.samples()[1].tolist() == [0, 1, 2]
    record.count = 5
    assert curve.samples(2)[1].tolist() == [2, 3, 4]


def test_the_last_pages_are_kept():
    pages = GraphPages()
    for _ in range(40):
        pages.begin_run(record_of("dispt", T, {"x": T}))
    assert [page.number for page in pages] == list(range(9, 41))


def test_settings_start_anew():
    assert DisplaySettings() == DisplaySettings(mode=1, first=14, net=7, thickness=1, white=False)


def test_old_pages_are_thinned_where_all_take_too_much(monkeypatch):
    """Three programs' pages of 8,000 bytes each, of which 20,000 in all are kept whole."""
    from desire_tui.engine.graph import pages as module
    from desire_tui.engine.session.session import Session
    from desire_tui.engine.source import Source

    monkeypatch.setattr(module, "PAGES_BYTES_MAX", 20_000)
    monkeypatch.setattr(module, "THINNED_ROWS", 10)
    session = Session(backend="reference")
    program = "x = 1 | TMAX = 1 | DT = 0.002 | NN = 501\ndrun\nDYNAMIC\nd/dt x = -x\ndispt x\n"
    for number in range(4):
        session.erun(Source(program + f"-- {number}\n"))
    oldest, *others = session.graphs.pages
    assert oldest.curves[0].count <= 10
    assert oldest.curves[0].record.t[-1] == 1.0
    assert oldest.caption == "x vs. t (thinned)"
    assert oldest.erased == 1  # a painter begins anew
    assert [page.curves[0].count for page in others] == [501] * 3
    session.erun(Source("x = 1\n"))
    assert [page.caption for page in session.graphs.pages] == ["x vs. t (thinned)"] * 2 + ["x vs. t"] * 2
