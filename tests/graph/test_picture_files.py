"""Pictures hold the right colours at the right places."""

from __future__ import annotations

from io import BytesIO

import numpy as np
import pytest

from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.graph.colors import curve_rgb, rgb
from desire_tui.engine.graph.pages import GraphPages
from desire_tui.engine.outputs.matplotlib_figure import picture_of
from desire_tui.engine.outputs.picture_files import write_picture
from desire_tui.engine.outputs.picture_options import PictureOptions, name_and_options
from tests.graph.graphing import displayed, page_of, record_of
from tests.runtime.running import session_for

T = np.linspace(0, 1, 200)


def pixels(graph, tmp_path):
    from matplotlib.image import imread

    write_picture(graph, tmp_path / "g.png")
    return np.rint(imread(tmp_path / "g.png")[:, :, :3] * 255).astype(int)


def share(image, color, near=0):
    return float((np.abs(image - np.array(color)) <= near).all(axis=2).mean())


def where(image, color):
    rows, columns = np.nonzero((np.abs(image - np.array(color)) <= 8).all(axis=2))
    return rows, columns


def test_black_background_and_curve_colours(tmp_path):
    page = page_of("dispt", T, {"x": 0.5 + 0 * T, "y": -0.5 + 0 * T}, "N10", "R")
    image = pixels(page, tmp_path)
    assert image.shape[:2] == (750, 1200)
    assert share(image, (0, 0, 0)) > 0.5
    upper, _ = where(image[:680], rgb(10))
    lower, _ = where(image[:680], rgb(11))
    assert len(upper)
    assert len(lower)
    assert upper.mean() < lower.mean()  # +0.5 stands above -0.5


def test_publication_graphs_are_black_on_white(tmp_path):
    page = page_of("dispt", T, {"x": np.sin(6 * T), "y": T}, "N-18", "C16", "R")
    image = pixels(page, tmp_path)
    assert share(image, (255, 255, 255)) > 0.8
    assert share(image, (0, 0, 0)) > 0.003
    assert (image.max(axis=2) - image.min(axis=2)).max() <= 2  # greys only


def test_pictures_are_made_for_paper_unless_the_program_chooses_colours(tmp_path):
    page = page_of("dispt", T, {"x": T})
    image = pixels(page, tmp_path)
    assert share(image, (255, 255, 255)) > 0.8
    assert share(image[:680], rgb(14, white=True), 8) > 0.001  # yellow is no colour on white
    assert share(np.rint(_image(picture_of(page, "png", PictureOptions(style="screen")))), (0, 0, 0)) > 0.8


def test_a_fitted_picture_holds_all_curves(tmp_path):
    page = page_of("dispt", T, {"x": 30 + 10 * T}, "N12", "R")
    assert not len(where(pixels(page, tmp_path)[:680], rgb(12))[0])
    page.fit = "asked"
    rows, columns = where(pixels(page, tmp_path)[:680], rgb(12))
    assert columns.max() - columns.min() > 1000
    assert rows.max() - rows.min() > 100
    write_picture(page, tmp_path / "g.svg")
    text = (tmp_path / "g.svg").read_text()
    assert "fitted" in text
    assert ">40<" in text


def test_size_and_dots_per_inch(tmp_path):
    write_picture(page_of("dispt", T, {"x": T}), tmp_path / "g.png", PictureOptions((6, 4), 300))
    assert _image((tmp_path / "g.png").read_bytes()).shape[:2] == (1200, 1800)


@pytest.mark.parametrize("kind", ["png", "svg", "pdf"])
def test_the_smallest_picture_is_made_without_a_word(kind, recwarn):
    page = page_of("dispt", T, {"a long name of a curve": T, "another long name": 1 - T})
    assert picture_of(page, kind, PictureOptions((1, 1)))
    assert not recwarn.list


def test_few_points_are_seen(tmp_path):
    t = np.arange(17.0)
    page = page_of("dispxy", t, {"x": 0.1 * t - 0.8, "y": 0.05 * t - 0.4}, "N12", rule=0)
    assert share(pixels(page, tmp_path)[:680], rgb(12), 8) > 17 * 50 / (680 * 1200)


def test_an_empty_frame_says_why(tmp_path):
    page = page_of("dispt", T, {"x": 30 + T, "y": 40 + T})
    write_picture(page, tmp_path / "g.svg")
    assert "2 curves outside" in (tmp_path / "g.svg").read_text()


def _image(png):
    from matplotlib.image import imread

    return imread(BytesIO(png))[:, :, :3] * 255


def test_thick_curves_are_thicker(tmp_path):
    amount = [
        share(pixels(page_of("dispt", T, {"x": T}, "N12", letter), tmp_path)[:680], rgb(12), 8)
        for letter in "QRY"
    ]
    assert amount[0] < amount[1] < amount[2]


def test_values_outside_are_cut_at_the_frame(tmp_path):
    page = page_of("dispt", T, {"x": 3 * np.sin(6.28 * T)}, "N12", "R", "C7")
    image = pixels(page, tmp_path)
    rows, _ = where(image[:680], rgb(12))
    sides = np.flatnonzero(np.bincount(where(image, rgb(7))[0], minlength=750) > 800)
    assert sides.max() - sides.min() > 500  # upper and lower side of the frame
    assert rows.min() >= sides.min() - 4
    assert rows.max() <= sides.max() + 4


def test_nan_and_inf_are_gaps(tmp_path):
    wild = np.where((T > 0.3) & (T < 0.7), np.nan, 0.5)
    image = pixels(page_of("dispt", T, {"x": wild, "y": np.full(200, np.inf)}, "N12"), tmp_path)
    _, columns = where(image[:680], rgb(12))
    middle = (columns > 0.4 * 1200) & (columns < 0.6 * 1200)
    assert len(columns)
    assert not middle.any()


def test_no_net_no_lines(tmp_path):
    with_net = pixels(page_of("dispt", T, {"x": T}, "C9", "N12"), tmp_path)
    without = pixels(page_of("dispt", T, {"x": T}, "C16", "N12"), tmp_path)
    assert share(with_net, rgb(9), 8) > 0.001
    assert share(without, rgb(9), 8) == 0


def test_points_and_pictures(tmp_path):
    pages = GraphPages()
    displayed(pages, "C7", "A", "Y")
    for k in range(50):
        pages.plot(k / 50, k / 50, 13, 1.0)
    assert share(pixels(pages.current, tmp_path), rgb(13), 8) > 0.0005
    pages.show("A", np.linspace(-1, 1, 64), 8, 1.0)
    image = pixels(pages.current, tmp_path)
    assert len(np.unique(image[:, :, 0])) > 30  # a wedge of greys


def test_arrays_shown_beside_curves(tmp_path):
    text = """\
ARRAY A[1,64] | for i = 1 to 64 | A[1,i] = (i - 32)/32 | next
display N10 | TMAX = 1 | NN = 11 | drun
DYNAMIC
d/dt x = 1
SHOW A, 8
dispt x
"""
    image = pixels(session_for(text).graph, tmp_path)
    _, curve = where(image[:680], rgb(10))
    assert len(curve)
    grey = image[:680, curve.max() + 10 :]
    assert len(np.unique(grey[:, :, 0])) > 30  # a wedge of greys, right of the curve


def test_a_map_of_fifty_thousand_points(tmp_path):
    random = np.random.default_rng(1)
    data = {"x": random.uniform(-1, 1, 50_000), "y": random.uniform(-1, 1, 50_000)}
    page = page_of("dispxy", np.arange(50_000.0), data, "N10", rule=0)
    assert share(pixels(page, tmp_path), rgb(10), 60) > 0.05


def test_a_million_samples(tmp_path):
    t = np.linspace(0, 1, 1_000_000)
    page = page_of("dispt", t, {"x": 0.9 * np.sin(3000 * t)}, "N10")
    assert share(pixels(page, tmp_path), rgb(10), 40) > 0.3


def test_earlier_runs_keep_their_scale(tmp_path):
    pages = GraphPages()
    displayed(pages, "2", "N10", "R")
    pages.begin_run(record_of("dispt", T, {"x": 0.5 + 0 * T}, scale=1.0))
    page = pages.begin_run(record_of("dispt", T + 1, {"x": 0.5 + 0 * T}, scale=10.0))
    drawn = pixels(page, tmp_path)[:680]
    first, second = (where(drawn, curve_rgb(curve.color))[0] for curve in page.curves)
    assert np.median(second) - np.median(first) > 80  # a quarter and almost half of the height down


@pytest.mark.parametrize("name", ["g.jpg", "g", "g.txt"])
def test_other_endings_are_refused(tmp_path, name):
    with pytest.raises(DesireError) as caught:
        write_picture(page_of("dispt", T, {"x": T}), tmp_path / name)
    assert caught.value.diagnostics[0].code == 34


def test_svg_keeps_text_as_text(tmp_path):
    write_picture(page_of("dispt", T, {"x": T, "y": T}), tmp_path / "g.svg")
    text = (tmp_path / "g.svg").read_text()
    assert ">x, y<" in text
    assert ">t<" in text
    assert "scale = 1" in text


@pytest.mark.parametrize(
    ("typed", "name", "inches", "dpi", "style"),
    [
        ("g.png", "g.png", (8, 5), 150, None),
        ("my graph.png 6x4 300dpi", "my graph.png", (6, 4), 300, None),
        ("'g.pdf' 3.5×2.5 paper", "g.pdf", (3.5, 2.5), 150, "paper"),
        ("g.svg screen 600 dpi", "g.svg", (8, 5), 600, "screen"),
        ("6x4", "6x4", (8, 5), 150, None),
    ],
)
def test_what_is_typed_behind_a_pictures_name(typed, name, inches, dpi, style):
    found, options = name_and_options(typed)
    assert (found, options.inches, options.dots_per_inch, options.style) == (name, inches, dpi, style)


@pytest.mark.parametrize("typed", ["g.png 0x4", "g.png 600x4", "g.png 3dpi", "g.png 5000 dpi"])
def test_sizes_that_no_picture_has(typed):
    with pytest.raises(ValueError, match=r"x4|dpi"):
        name_and_options(typed)
