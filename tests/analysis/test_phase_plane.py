"""Phase planes whose nullclines, steady states, manifolds and basins can be written down."""

from __future__ import annotations

import numpy as np
import pytest

from desire_tui.analysis.marks import marks
from desire_tui.analysis.phase_plane.phase import analyse
from desire_tui.analysis.progress import unwatched
from desire_tui.engine.diagnostics import DesireError

# R. FitzHugh, Biophys. J. 1 (1961), 445, with the constants of J. Nagumo, Proc. IRE 50 (1962), 2061
FITZHUGH_NAGUMO = """a = 0.7 | b = 0.8 | c = 3 | z = 0.4 | v = -1 | w = 0.5 | TMAX = 50 | DT = 0.01 | NN = 501
drun
DYNAMIC
d/dt v = c*(v - v^3/3 + w - z)
d/dt w = -(v - a + b*w)/c
dispxy v, w
"""
COMPETITION = """a = 1.5 | x = 0.4 | y = 0.3 | TMAX = 20 | DT = 0.01 | NN = 201
drun
DYNAMIC
d/dt x = x*(1 - x - a*y)
d/dt y = y*(1 - y - a*x)
dispxy x, y
"""
LORENZ = """s = 10 | r = 28 | b = 8/3 | x = 1 | y = 1 | z = 20 | TMAX = 2 | DT = 0.01 | NN = 101
drun
DYNAMIC
d/dt x = s*(y - x)
d/dt y = x*(r - z) - y
d/dt z = x*y - b*z
dispxy x, z
"""
SQUARE = "in x = [0, 1.5], y = [0, 1.5]"


def series(found, name):
    (one,) = [s for s in found.charts[0].series if s.name == name]
    is_place = np.isfinite(one.x)
    return one.x[is_place], one.y[is_place]


def test_fitzhugh_nagumo(subject):
    """The resting state and both nullclines; at z = 0 it is v = 1.1994, w = -0.6243 (FitzHugh)."""
    model = subject(FITZHUGH_NAGUMO, settings={"z": 0.0})
    found = analyse(model, "in v = [-2.5, 2.5], w = [-2, 2] without basins", unwatched)
    assert found["states"]["v"] == pytest.approx([1.1994], abs=5e-5)
    assert found["states"]["w"] == pytest.approx([-0.6243], abs=5e-5)
    assert found["kinds"] == ["stable focus"]
    v, w = found["nullclines"]["v"]
    is_place = np.isfinite(v)
    assert w[is_place] == pytest.approx(v[is_place] ** 3 / 3 - v[is_place], abs=1e-7)
    assert (v[is_place].min(), v[is_place].max()) == pytest.approx((-2.2, 2.2), abs=0.2)
    v, w = found["nullclines"]["w"]
    is_place = np.isfinite(v)
    assert w[is_place] == pytest.approx((0.7 - v[is_place]) / 0.8, abs=1e-9)


def test_two_competitors_share_the_plane_along_the_saddles_stable_manifold(subject):
    found = analyse(subject(COMPETITION), SQUARE, unwatched)
    order = np.lexsort((found["states"]["y"], found["states"]["x"]))
    places = np.column_stack([found["states"]["x"], found["states"]["y"]])[order]
    assert places == pytest.approx(np.array([[0, 0], [0, 1], [0.4, 0.4], [1, 0]]), abs=1e-12)
    kinds = [found["kinds"][k] for k in order]
    assert kinds == ["unstable node", "stable node", "saddle", "stable node"]
    assert found["basins"] == pytest.approx({"to x = 1, y = 0": 0.5, "to x = 0, y = 1": 0.5}, abs=1e-3)
    # the diagonal is the stable manifold; the unstable one leads to both nodes
    x, y = series(found, "stable manifold")
    assert x == pytest.approx(y, abs=1e-9)
    assert (x.min(), x.max()) == pytest.approx((0.0, 1.5), abs=0.02)
    x, y = series(found, "unstable manifold")
    for node in ([1, 0], [0, 1]):
        assert np.hypot(x - node[0], y - node[1]).min() < 0.02
    grounds = [s for s in found.charts[0].series if s.look == "points"]
    assert len(grounds) == 2
    assert all(np.all(s.x > s.y) or np.all(s.x < s.y) for s in grounds)


def test_arrows_show_the_direction(subject):
    found = analyse(subject(COMPETITION), f"{SQUARE} without basins", unwatched)
    field = found.charts[0].series[0]
    x, y = field.x.reshape(-1, 7), field.y.reshape(-1, 7)
    along_x, along_y = x[:, 1] - x[:, 0], y[:, 1] - y[:, 0]
    middle_x, middle_y = x[:, :2].mean(axis=1), y[:, :2].mean(axis=1)
    rate_x, rate_y = middle_x * (1 - middle_x - 1.5 * middle_y), middle_y * (1 - middle_y - 1.5 * middle_x)
    assert along_x * rate_y == pytest.approx(along_y * rate_x, abs=1e-12)
    assert np.all(along_x * rate_x + along_y * rate_y > 0.0)


def test_it_follows_parameters_and_begins_orbits(subject):
    found = analyse(subject(COMPETITION), f"{SQUARE} without basins", unwatched)
    chart = found.live.moved({"a": 0.5, "unknown": 1.0})
    x, y = next((s.x, s.y) for s in chart.series if s.name == "x stands still")
    inside = np.isfinite(x) & (x > 0.05)
    assert x[inside] + 0.5 * y[inside] == pytest.approx(1.0, abs=1e-9)
    before = len(chart.series)
    begun = found.live.started(1.2, 0.1)
    assert len(begun.series) == before + 1
    fresh = analyse(subject(COMPETITION), f"{SQUARE} without basins", unwatched)
    kept = {s.name for s in fresh.live.started(0.5, 0.9).series}
    assert {"run", "stable manifold"} <= kept, "an orbit at the same parameters leaves what is there"
    orbit = next(s for s in begun.series if len(s.x) and s.x[0] == pytest.approx(1.2))
    on_way = np.isfinite(orbit.x)
    assert (orbit.x[on_way][-1], orbit.y[on_way][-1]) == pytest.approx((2 / 3, 2 / 3), abs=0.05)
    assert len(found.live.moved({"a": 1.5}).series) >= len(begun.series), "the orbit goes on with it"


def test_more_states_are_held_or_follow_from_sums(subject):
    found = analyse(subject(LORENZ), "", unwatched)
    assert found.charts[0].x_name == "x"
    assert found.charts[0].y_name == "z"
    assert any("field and nullclines are those with y = " in note for note in found.notes)
    assert max(found["states"]["z"]) == pytest.approx(27.0)
    chain = """k = 2 | a = 1 | b = 0 | c = 0 | TMAX = 9 | DT = 0.01 | NN = 101
drun
DYNAMIC
d/dt a = -k*a + b
d/dt b = k*a - 2*b + c
d/dt c = b - c
dispxy a, c
"""
    found = analyse(subject(chain), "in a = [0, 1], c = [0, 1]", unwatched)
    assert not any("are those with" in note for note in found.notes)
    assert found["states"]["c"] == pytest.approx([0.4])
    a, c = found["nullclines"]["a"]
    is_place = np.isfinite(a)
    assert c[is_place] == pytest.approx(1 - 3 * a[is_place], abs=1e-9)  # b = 2 a, a + b + c = 1


@pytest.mark.parametrize(
    ("request_", "words"),
    [
        ("x, x", "'x' stands twice"),
        ("x, q", "'q' is no state"),
        ("in x = [2, 1]", "the interval from 2 to 1 holds nothing"),
        ("without saddles", "'saddles' stands where 'basins' is expected"),
    ],
)
def test_requests_that_are_wrong(subject, request_, words):
    with pytest.raises(DesireError) as error:
        analyse(subject(COMPETITION), request_, unwatched)
    assert words in error.value.diagnostics[0].message


def test_one_state_has_no_plane(subject):
    with pytest.raises(DesireError) as error:
        analyse(
            subject("x = 1 | TMAX = 1 | DT = 0.1 | NN = 11\ndrun\nDYNAMIC\nd/dt x = -x\ndispt x\n"),
            "",
            unwatched,
        )
    assert "needs two states" in error.value.diagnostics[0].message


def test_a_stop_keeps_what_is_drawn(subject):
    found = analyse(subject(COMPETITION), SQUARE, lambda part, *_: part is None)
    assert found.is_partial
    assert not found["basins"]
    assert len(found["kinds"]) == 4


def test_marks_stand_around_their_places():
    found = marks("cross", np.array([[0.2, 0.7], [0.5, 0.1]]))
    left, right = np.nanmin(found, axis=1), np.nanmax(found, axis=1)
    assert (left + right) / 2 == pytest.approx([0.45, 0.3])
