"""Bifurcations of published models, and of models whose bifurcations can be written down."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from desire_tui.analysis.continuation.continuation import analyse
from desire_tui.analysis.progress import unwatched
from desire_tui.analysis.subject import Subject
from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.source import Source

# AUTO's example `ab`: A. Uppal, W. H. Ray, A. B. Poore, Chem. Eng. Sci. 29 (1974), 967
AB = """p1 = 0 | p2 = 14 | p3 = 2 | u1 = 0 | u2 = 0 | TMAX = 10 | DT = 0.01 | NN = 101
drun
DYNAMIC
d/dt u1 = -u1 + p1*(1 - u1)*exp(u2)
d/dt u2 = -u2 + p1*p2*(1 - u1)*exp(u2) - p3*u2
dispt u1, u2
"""
# AUTO's example `pp2`
PP2 = """p1 = 0 | p2 = 3 | p3 = 5 | p4 = 3 | u1 = 0.5 | u2 = 0.5 | TMAX = 30 | DT = 0.01 | NN = 301
drun
DYNAMIC
d/dt u1 = p2*u1*(1 - u1) - u1*u2 - p1*(1 - exp(-p3*u1))
d/dt u2 = -u2 + p4*u1*u2
dispxy u1, u2
"""
# AUTO's example `lor`: E. N. Lorenz, J. Atmos. Sci. 20 (1963), 130
LOR = """s = 10 | b = 8/3 | rho = 28 | x = 1 | y = 1 | z = 20 | TMAX = 20 | DT = 0.001 | NN = 2001
drun
DYNAMIC
d/dt x = s*(y - x)
d/dt y = x*(rho - z) - y
d/dt z = x*y - b*z
dispxy x, z
"""
# AUTO's example `frc`: FitzHugh-Nagumo's equations driven by an oscillator
FRC = """a = 0.5 | b = 0.5 | r = 0 | eps = 0.005 | bet = 100 | d = 1
v = 0.5 | w = 0 | x = 0 | y = 1 | TMAX = 2 | DT = 0.0001 | NN = 201
drun
DYNAMIC
ss = x*x + y*y
d/dt v = (v*(v - a)*(1 - v) - w)/eps
d/dt w = v - d*w - (b + r*x)
d/dt x = x + bet*y - x*ss
d/dt y = -bet*x + y - y*ss
dispxy v, w
"""
# J. Rinzel, G. B. Ermentrout, Analysis of neural excitability and oscillations, in: Koch, Segev (1989)
MORRIS_LECAR = """gca = 4.4 | gk = 8 | gl = 2 | vca = 120 | vk = -84 | vl = -60 | cm = 20
v1 = -1.2 | v2 = 18 | v3 = 2 | v4 = 30 | phi = 0.04 | i = 90 | v = -60 | w = 0.01 | TMAX = 200 | DT = 0.05 | NN = 1001
drun
DYNAMIC
minf = 0.5*(1 + tanh((v - v1)/v2))
winf = 0.5*(1 + tanh((v - v3)/v4))
rate = phi*cosh((v - v3)/(2*v4))
d/dt v = (i - gca*minf*(v - vca) - gk*w*(v - vk) - gl*(v - vl))/cm
d/dt w = rate*(winf - w)
dispxy v, w
"""
VAN_DER_POL = """mu = 1 | x = 2 | v = 0 | TMAX = 30 | DT = 0.01 | NN = 301
drun
DYNAMIC
d/dt x = v
d/dt v = mu*(1 - x*x)*v - x
dispxy x, v
"""
ROESSLER = """a = 0.2 | b = 0.2 | c = 2.5 | x = 2 | y = 1 | z = 1 | TMAX = 200 | DT = 0.005 | NN = 2001
drun
DYNAMIC
d/dt x = -y - z
d/dt y = x + a*y
d/dt z = b + z*(x - c)
dispxy x, y
"""
NORMAL_FORM = """mu = -0.5 | s = -1 | w = 2 | x = 0.3 | y = 0 | TMAX = 20 | DT = 0.01 | NN = 101
drun
DYNAMIC
q = x*x + y*y
d/dt x = mu*x - w*y + s*x*q
d/dt y = w*x + mu*y + s*y*q
dispxy x, y
"""


@cache
def diagram(text, request, **settings):
    return analyse(Subject(Source(text, "test.src"), settings=settings), request, unwatched)


def points(found, kind, name):
    return [point[name] for point in found["points"] if point["kind"] == kind]


def told(text, request):
    with pytest.raises(DesireError) as error:
        analyse(Subject(Source(text, "test.src")), request, unwatched)
    (problem,) = error.value.diagnostics
    return problem.message


def test_ab_as_auto_has_it():
    """The figures are those of AUTO's manual: LP 1.05739E-01 and 8.89318E-02, HB 1.30900E-01."""
    found = diagram(AB, "p1 in [0, 0.2]")
    assert points(found, "fold", "p1") == pytest.approx([0.105739, 0.0889318], rel=5e-6)
    assert points(found, "fold", "u1") == pytest.approx([0.311018, 0.688982], rel=5e-6)
    assert points(found, "fold", "u2") == pytest.approx([1.45142, 3.21525], rel=5e-6)
    assert points(found, "Hopf", "p1") == pytest.approx([0.130900], rel=5e-6)
    assert points(found, "Hopf", "u1") == pytest.approx([0.895080], rel=5e-6)
    # exact: u2 = 14 u1 / 3, and at folds d p1/d u1 = 0, which is 14 u1 (1 - u1) = 3
    roots = np.roots([14, -14, 3])
    assert np.sort(points(found, "fold", "u1")) == pytest.approx(np.sort(roots), abs=1e-10)
    steady, cycles = found["branches"]
    assert steady["stable"][0]
    assert steady["p1"][[0, -1]] == pytest.approx([0, 0.2], abs=1e-12)
    assert cycles["from"] == "Hopf 1"
    assert np.all(cycles["stable"][:10])
    assert cycles["period"][-1] > 20.0 * cycles["period"][0]


def test_pp2_has_two_branch_points_and_a_hopf_point_that_can_be_written_down():
    found = diagram(PP2, "p1 in [0.05, 1] without cycles")
    e = np.exp(-5 / 3)
    assert sorted(points(found, "branch point", "p1")) == pytest.approx([0.6, 2 / 3 / (1 - e)], abs=1e-10)
    assert points(found, "Hopf", "p1") == pytest.approx([1 / (3 - 8 * e)], abs=1e-9)
    assert len(found["branches"]) == 3
    u1 = points(found, "fold", "u1")
    # p1 = 3 u (1 - u) / (1 - exp(-5 u)) is largest there
    assert u1 == pytest.approx([0.4111615613], abs=1e-8)
    (p1,) = points(found, "fold", "p1")
    around = np.linspace(u1[0] - 0.1, u1[0] + 0.1, 2001)
    assert p1 == pytest.approx((3 * around * (1 - around) / (1 - np.exp(-5 * around))).max(), abs=1e-8)


def test_lorenz_to_the_homoclinic_orbit():
    """The pitchfork at 1, Hopf at s (s + b + 3)/(s - b - 1); C. Sparrow (1982) has the homoclinic orbit at 13.926."""
    found = diagram(LOR, "rho in [0, 30] without cycles")
    assert points(found, "branch point", "rho") == pytest.approx([1.0], abs=1e-9)
    assert points(found, "Hopf", "rho") == pytest.approx([470 / 19, 470 / 19], rel=1e-9)
    assert all(p["lyapunov"] > 0.0 for p in found["points"] if p["kind"] == "Hopf")
    found = diagram(LOR, "rho in [12, 30] from x = 8, y = 8, z = 27")
    assert [branch["of"] for branch in found["branches"]] == ["steady", "cycle"]
    cycles = found["branches"][1]
    assert cycles["rho"][-1] == pytest.approx(13.926, abs=1e-3)
    assert not np.any(cycles["stable"])
    assert any("grows without bound" in note for note in found.notes)


def test_morris_lecar_between_its_hopf_points():
    """Rinzel and Ermentrout: Hopf points at 93.86 and 212, cycles from 88.3 to 217."""
    found = diagram(MORRIS_LECAR, "i in [0, 300]")
    assert points(found, "Hopf", "i") == pytest.approx([93.86, 212.02], abs=5e-3)
    assert points(found, "fold of cycles", "i") == pytest.approx([88.29, 216.9], abs=5e-3)
    assert len(found["branches"]) == 2, "the cycles go from one Hopf point to the other"
    cycles = found["branches"][1]
    between = (cycles["i"] > 95) & (cycles["i"] < 210) & cycles["stable"]
    assert np.all(cycles["v"][between] > 20.0)
    chart = found.charts[0]
    by_name = {one.name: one for one in chart.series}
    assert set(by_name) == {
        "stable",
        "unstable",
        "stable cycles",
        "unstable cycles",
        "Hopf",
        "fold of cycles",
    }
    assert by_name["unstable"].look == "dashes"
    dashes = by_name["unstable"].x[np.isfinite(by_name["unstable"].x)]
    assert (dashes.min(), dashes.max()) == pytest.approx((93.86, 212.02), abs=5e-3)


def test_van_der_pol_has_its_published_period():
    """D. Viswanath and others: 6.6632868593231301896996820305 at mu = 1."""
    found = diagram(VAN_DER_POL, "mu in [0.9, 1.1] from cycle")
    first = found["branches"][0]
    assert first["mu"][0] == pytest.approx(1.0, abs=1e-15)
    assert first["period"][0] == pytest.approx(6.6632868593231301897, rel=1e-11)
    assert {b["mu"][-1] for b in found["branches"]} == {0.9, 1.1}
    # the other multiplier is exp of the integral of the divergence mu (1 - x^2) over a period
    other = first["multipliers"][0][1].real
    assert other == pytest.approx(8.59695e-4, rel=1e-5)


def test_a_centre_ends_its_cycles(subject):
    """x'' = mu (1 - x^2) x' - x: at mu = 0 every circle is an orbit, the branch of cycles stands upright."""
    text = """mu = 1 | x = 2 | y = 0 | TMAX = 30 | DT = 0.01 | NN = 1001
drun
DYNAMIC
d/dt x = y
d/dt y = mu*(1 - x*x)*y - x
dispxy x, y
"""
    found = analyse(subject(text), "mu in [-1, 3]", unwatched)
    assert any("it is a centre" in note for note in found.notes)
    assert found.tables[1].columns["ends"][1] == "begins, runs off"


@pytest.mark.parametrize(("s", "stable"), [(-1.0, True), (1.0, False)])
def test_cycles_of_the_normal_form_are_circles(s, stable):
    """Radius √(mu/-s), period 2π/w, multiplier exp(-2 mu T)."""
    found = diagram(NORMAL_FORM, "mu in [-1, 1]", s=s)
    (hopf,) = [p for p in found["points"] if p["kind"] == "Hopf"]
    assert hopf["mu"] == pytest.approx(0.0, abs=1e-9)
    assert hopf["period"] == pytest.approx(np.pi)
    assert np.sign(hopf["lyapunov"]) == s
    # 2 s/w in the measure of the states themselves, which are divided by a power of 2
    powers = np.log2(hopf["lyapunov"] / (2 * s / 2)) / 2
    assert powers == pytest.approx(round(powers), abs=1e-6)
    cycles = found["branches"][1]
    inside = np.abs(cycles["mu"]) > 1e-3
    assert cycles["x"] == pytest.approx(np.sqrt(cycles["mu"] / -s), rel=2e-3)  # the largest of the nodes
    assert cycles["period"] == pytest.approx(np.pi, rel=1e-9)
    others = np.array([min(row, key=lambda m: -abs(m - 1)) for row in cycles["multipliers"]])
    assert others.real == pytest.approx(np.exp(-2 * cycles["mu"] * np.pi), rel=1e-5)
    assert np.all(cycles["stable"][inside] == stable)


def test_roessler_doubles_its_period_again_and_again():
    """The cascade of a = b = 0.2: 2.83, 3.84, 4.12 (H.-O. Peitgen, H. Jürgens, D. Saupe, Chaos and Fractals)."""
    found = diagram(ROESSLER, "c in [2.4, 4.2] from cycle")
    assert points(found, "period doubling", "c") == pytest.approx([2.83, 3.84, 4.12], abs=6e-3)
    periods = points(found, "period doubling", "period")
    assert periods[1] / periods[0] == pytest.approx(2.0, rel=0.01)
    doubled = next(b for b in found["branches"] if b["from"] == "period doubling 1")
    c, stable = doubled["c"], doubled["stable"]
    assert np.all(stable[(c > 2.84) & (c < 3.83)])
    assert not np.any(stable[c > 3.85])


def test_a_torus_is_born_where_trace_and_sum_say():
    """W. F. Langford (1984), with its symmetry: cycles at z = b of radius r turn once in 2π/d."""
    text = """a = 0.95 | b = 0.9 | c = 0.6 | d = 3.5 | e = 0.25 | x = 0.1 | y = 0 | z = 1
TMAX = 20 | DT = 0.01 | NN = 501
drun
DYNAMIC
d/dt x = (z - b)*x - d*y
d/dt y = d*x + (z - b)*y
d/dt z = c + a*z - z*z*z/3 - (x*x + y*y)*(1 + e*z)
dispxy x, z
"""
    found = diagram(text, "b in [0.6, 2.2]")
    (torus,) = [p for p in found["points"] if p["kind"] == "torus"]
    assert torus["period"] == pytest.approx(2 * np.pi / 3.5, rel=1e-8)
    # in the plane of r and z the trace a - b^2 - e r^2 is 0, with r^2 (1 + e b) = c + a b - b^3/3
    b = torus["b"]
    assert 0.95 - b**2 == pytest.approx(0.25 * (0.6 + 0.95 * b - b**3 / 3) / (1 + 0.25 * b), abs=1e-6)
    cycles = next(one for one in found["branches"] if one["of"] == "cycle")
    apart = np.abs(cycles["b"] - b) > 1e-6
    assert np.all(cycles["stable"][apart] == (cycles["b"][apart] > b))


def test_a_closed_curve_of_steady_states_is_followed_once():
    text = (
        "k = 0 | x = 0.5 | TMAX = 5 | DT = 0.01 | NN = 11\ndrun\nDYNAMIC\nd/dt x = 1 - x*x - k*k\ndispt x\n"
    )
    found = diagram(text, "k in [-2, 2]")
    (branch,) = found["branches"]
    assert branch["k"] ** 2 + branch["x"] ** 2 == pytest.approx(1.0, abs=1e-12)
    assert sorted(points(found, "fold", "k")) == pytest.approx([-1, 1], abs=1e-10)
    assert (branch["k"][0], branch["x"][0]) == (branch["k"][-1], branch["x"][-1])
    angles = np.unwrap(np.arctan2(branch["x"], branch["k"]))
    assert abs(angles[-1] - angles[0]) == pytest.approx(2 * np.pi)


def test_a_forced_system_follows_its_oscillator():
    """Without a force v and w stand still: multipliers and the answer to a weak one are linear algebra."""
    found = diagram(FRC, "r in [0, 1] from cycle")
    (branch,) = [b for b in found["branches"] if len(b["r"]) > 2]
    turn = 2 * np.pi / 100
    assert branch["period"] == pytest.approx(turn, rel=1e-9)
    assert branch["x"] == pytest.approx(1.0, abs=1e-3)
    still = np.array([[50.0, -200.0], [1.0, -1.0]])  # v (v - 1/2) (1 - v) has the slope 1/4 at 1/2
    expected = [*np.exp(np.linalg.eigvals(still) * turn), 1.0, np.exp(-2 * turn)]
    assert np.sort(branch["multipliers"][0].real) == pytest.approx(np.sort(expected), rel=1e-6)
    assert not np.any(branch["stable"])
    answer = np.linalg.solve(100j * np.eye(2) - still, [0.0, -1.0])
    weak = (branch["r"] > 0.0) & (branch["r"] < 0.3)
    assert np.any(weak)
    assert branch["v"][weak] - 0.5 == pytest.approx(abs(answer[0]) * branch["r"][weak], rel=5e-3)


def test_curves_over_two_parameters_meet_at_cusps():
    """Of ab: folds are at p3 + 1 = 14 u (1 - u) with p1 = u exp(-u2)/(1 - u): the cusp is at u = 1/2."""
    found = diagram(AB, "p1 in [0, 0.2], p3 in [0, 4]")
    (cusp,) = [p for p in found["points"] if p["kind"] == "cusp"]
    assert (cusp["p1"], cusp["p3"], cusp["u1"]) == pytest.approx((np.exp(-2), 2.5, 0.5), abs=1e-8)
    folds, hopf = found["branches"]
    u = folds["u1"]
    assert folds["p3"] == pytest.approx(14 * u * (1 - u) - 1, abs=1e-9)
    assert folds["p1"] == pytest.approx(u / (1 - u) * np.exp(-1 / (1 - u)), abs=1e-9)
    trace = -1 - hopf["u1"] / (1 - hopf["u1"]) - (1 + hopf["p3"]) + 14 * hopf["u1"]
    assert trace == pytest.approx(0.0, abs=1e-6)
    ends = [p for p in found["points"] if p["kind"] == "Bogdanov-Takens"]
    on_both = [p["p3"] for p in ends if p["p3"] < 1.0]
    assert len(on_both) == 2
    assert on_both[0] == pytest.approx(on_both[1], abs=1e-6)


def test_a_point_is_chosen_by_its_number():
    found = diagram(AB, "p1 in [0, 0.2], p3 in [1, 3] from Hopf 1")
    assert [b["from"] for b in found["branches"]] == ["Hopf 1"]
    assert found["branches"][0]["of"] == "Hopf"
    assert "there is fold 1, fold 2, Hopf 1" in told(AB, "p1 in [0, 0.2], p3 in [1, 3] from fold 3")


def test_conserved_sums_are_held():
    text = """k = 1 | a = 1 | b = 0 | TMAX = 5 | DT = 0.01 | NN = 51
drun
DYNAMIC
r = k*a - b
d/dt a = -r
d/dt b = r
dispt a, b
"""
    found = diagram(text, "k in [0.5, 2]")
    (branch,) = found["branches"]
    assert branch["a"] == pytest.approx(1 / (1 + branch["k"]), abs=1e-12)
    assert any(note == "conserved: a + b = 1" for note in found.notes)


@pytest.mark.parametrize(
    ("text", "request_", "words"),
    [
        (AB, "q in [0, 1]", "'q' is no parameter"),
        (AB, "p1 in [1, 0]", "the interval from 1 to 0 holds nothing"),
        (AB, "p1 in [0, 1], p1 in [0, 1]", "'p1' is continued already"),
        (AB, "p1 in [0, 1] from fold 1", "folds, Hopf points and the like are continued over two parameters"),
        (AB, "p1 in [0, 1], p2 in [1, 2] from here", "over two parameters, folds, Hopf points"),
        (AB, "p1 in [0, 1], p2 in [1, 20] from fold 0", "the number of a point is 1 or more"),
        (AB, "p1 in [0, 0.2], p3 in [5, 6]", "p3 = 2 is not in its range"),
        (AB, "p1 in [0, 1] from v = 1", "'v' is no state"),
        (AB, "p1 in [0, 0.2] from cycle", "comes to a steady state, not to a cycle"),
        ("k = 1 | j = 2 | x = 1 | TMAX = 1 | DT = 0.1 | NN = 11\ndrun\nDYNAMIC\nd/dt x = -k*x\ny = j*x\ndispt x, y\n",
         "j in [0, 1]", "j has no influence"),
        ("k = 1 | x = 1 | TMAX = 1 | DT = 0.1 | NN = 11\ndrun\nDYNAMIC\nd/dt x = k + x*x\ndispt x\n",
         "k in [0.5, 2]", "no steady state is found at k = 1"),
    ],
)  # fmt: skip
def test_what_cannot_be_followed_says_why(text, request_, words):
    assert words in told(text, request_)


def test_it_begins_where_it_is_told(subject):
    text = (
        "k = 1 | x = 3 | TMAX = 1 | DT = 0.01 | NN = 11\ndrun\nDYNAMIC\nd/dt x = sin(x) - k*x*0.01\ndispt x\n"
    )
    found = analyse(subject(text), "k in [0.5, 2] from x = 6.4", unwatched)
    assert found["branches"][0]["x"] == pytest.approx(2 * np.pi, abs=0.5)
    found = analyse(subject(text, here={"x": 0.1}), "k in [0.5, 2] from here", unwatched)
    assert found["branches"][0]["x"] == pytest.approx(0.0, abs=1e-12)


def test_it_shows_what_it_has_and_can_be_stopped(subject, monkeypatch):
    monkeypatch.setattr("desire_tui.analysis.continuation.continuation._DRAWN_EVERY", 0.0)
    shown = []

    def progress(part, told, so_far=None):
        shown.append(so_far)
        return len(shown) < 30

    found = analyse(subject(AB), "p1 in [0, 0.2]", progress)
    assert found.is_partial
    assert len(found["branches"]) == 1
    counts = [len(one.tables[2].columns["p1"]) for one in shown if one is not None]
    assert counts == sorted(counts)
    assert len(counts) > 10


def test_many_branch_points_in_one_step_are_told_apart(subject):
    """Of the uniform state of a chain, a = 0.02 sin²(k π/10): steps are as long as three of them are apart."""
    text = """n = 4 | a = 0.5
STATE u[n]
u[1] = 0.1 | TMAX = 10 | DT = 0.01 | NN = 11
drun
DYNAMIC
Vectr d/dt u = a*u - u*u*u + 0.005*(u{1} - 2*u + u{-1})
dispt u[1]
"""
    found = analyse(
        subject(text), "a in [-1, 1] from u[1] = 0", lambda part, told, so_far=None: "branch 2" not in told
    )
    assert found.is_partial, "the branches that cross are many: the first is enough"
    trivial = [p["a"] for p in found["points"] if p["kind"] == "branch point" and p["branch"] == 1]
    assert sorted(trivial) == pytest.approx(0.02 * np.sin(np.arange(1, 5) * np.pi / 10) ** 2, abs=1e-9)
