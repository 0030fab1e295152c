"""`fit`: parameters that are known are found, as often as the intervals say; mistakes are told at their place."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from desire_tui.analysis.fit.analysis import analyse, fit
from desire_tui.analysis.fit.comparison import analyse as compare
from desire_tui.analysis.fit.curves import cubic_weights
from desire_tui.analysis.fit.request import read_request
from desire_tui.analysis.progress import unwatched
from desire_tui.engine.data_files.data_file import DataFile
from desire_tui.engine.diagnostics import DesireError

DECAY = """k = 1 | x = 1 | c = 0 | unused = 3 | irule 3
TMAX = 5 | DT = 0.01 | NN = 11
drun
DYNAMIC
d/dt x = -k*x
y = x + c
dispt x
"""
SIR = """N = 1000 | b = 0.3 | g = 0.2 | S = N - 1 | J = 1
TMAX = 60 | DT = 0.1 | NN = 121 | irule 3
drun
DYNAMIC
flow = b*S*J/N
d/dt S = -flow
d/dt J = flow - g*J
dispt S, J
"""
BALL = """g = 9 | e = 0.7 | y = 9 | irule 3
TMAX = 5 | DT = 0.002 | NN = 51
drun
DYNAMIC
d/dt y = v
d/dt v = -g
dispt y
event -y
v = -e*v | y = 0
"""


def table(**columns):
    return DataFile("made.csv", {name: np.asarray(column, dtype=float) for name, column in columns.items()})


def run_fit(subject, text, request, *files, **settings):
    return fit(subject(text, **settings), read_request(request), files, unwatched)


def problem(subject, text, request, *files):
    with pytest.raises(DesireError) as error:
        run_fit(subject, text, request, *files)
    (diagnostic,) = error.value.diagnostics
    return diagnostic


def decay(t, k, x, noise=0.0, seed=0):
    return x * np.exp(-k * t) + noise * np.random.default_rng(seed).normal(size=len(t))


T = np.linspace(0.1, 4.9, 49)


def test_exact_data_give_exact_parameters(subject):
    found = run_fit(subject, DECAY, "k, x in [0, 10] to x", table(t=T, x=decay(T, 0.7, 3.2)))
    assert found["converged"]
    assert found["k"] == pytest.approx(0.7, abs=1e-7)
    assert found["x"] == pytest.approx(3.2, abs=1e-7)
    assert found["runs"] < 20


def test_times_between_samples(subject):
    t = np.sort(np.random.default_rng(3).uniform(0, 5, 40))
    found = run_fit(subject, DECAY, "k, x to x", table(t=t, x=decay(t, 0.7, 3.2)))
    assert (found["k"], found["x"]) == (pytest.approx(0.7, abs=1e-7), pytest.approx(3.2, abs=1e-7))


def test_errors_and_correlations_are_those_of_linear_theory(subject):
    """The same model in closed form through scipy's curve_fit."""
    from scipy.optimize import curve_fit

    data = decay(T, 0.7, 3.2, 0.1, seed=5)
    values, covariance = curve_fit(lambda t, k, x: x * np.exp(-k * t), T, data, (1, 1))
    found = run_fit(subject, DECAY, "k, x to x", table(t=T, x=data))
    assert [found["k"], found["x"]] == pytest.approx(values, rel=1e-6)
    errors = np.sqrt(np.diag(covariance))
    assert list(found["errors"].values()) == pytest.approx(errors, rel=1e-5)
    assert found["correlations"][0, 1] == pytest.approx(covariance[0, 1] / errors.prod(), rel=1e-5)
    rest = data - values[1] * np.exp(-values[0] * T)
    assert found["standard deviation of x"] == pytest.approx(np.sqrt(rest @ rest / 47), rel=1e-6)
    sigma = rest @ rest / 47
    aic = rest @ rest / sigma and 49 * np.log(rest @ rest / 49) + 2 * 3
    assert found["AIC"] == pytest.approx(aic, rel=1e-6)


def test_given_weights_are_taken_as_they_are(subject):
    from scipy.optimize import curve_fit

    sigma = 0.05 + 0.1 * T
    data = decay(T, 0.7, 3.2) + sigma * np.random.default_rng(1).normal(size=len(T))
    values, covariance = curve_fit(
        lambda t, k, x: x * np.exp(-k * t), T, data, (1, 1), sigma=sigma, absolute_sigma=True
    )
    file = table(t=T, x=data, s=sigma)
    found = run_fit(subject, DECAY, "k, x to x weights s", file)
    assert [found["k"], found["x"]] == pytest.approx(values, rel=1e-6)
    assert list(found["errors"].values()) == pytest.approx(np.sqrt(np.diag(covariance)), rel=1e-5)
    same = run_fit(subject, DECAY, "k, x to x weights 0.2", table(t=T, x=data))
    assert same["errors"]["x"] != pytest.approx(found["errors"]["x"], rel=0.1)


def test_known_parameters_lie_in_their_intervals_95_times_of_100(subject):
    """Of 200 made-up experiments at least 91.5 % and at most 98.5 % of the intervals hold each: ± 2.3 sigma."""
    program = subject(DECAY)
    asked = read_request("k in [0, 5], x = 2 log to x")
    inside = np.zeros(2)
    for seed in range(200):
        found = fit(program, asked, [table(t=T, x=decay(T, 0.7, 3.2, 0.2, seed))], unwatched)
        for number, (name, true) in enumerate((("k", 0.7), ("x", 3.2))):
            low, high = found["intervals"][name]
            inside[number] += low <= true <= high
    assert np.all(inside >= 183), inside
    assert np.all(inside <= 197), inside


def test_an_epidemic(subject):
    """Figures of an independent integration (scipy, LSODA, 1e-12)."""
    from scipy.integrate import solve_ivp

    t = np.arange(0.0, 61.0, 2.0)

    def slope(_t, z):
        flow = 0.4 * z[0] * z[1] / 1000
        return [-flow, flow - 0.1 * z[1]]

    made = solve_ivp(slope, (0, 60), [999, 2], "LSODA", t, rtol=1e-12, atol=1e-10).y[1]
    noise = np.random.default_rng(11).normal(size=len(t)) * 5
    found = run_fit(subject, SIR, "b in [0.01, 2], g, J to J ~ ill", table(day=t, ill=made + noise))
    for name, true in (("b", 0.4), ("g", 0.1), ("J", 2.0)):
        low, high = found["intervals"][name]
        assert low < true < high
        assert high - low < 0.5 * true
    assert found["standard deviation of J"] == pytest.approx(5, rel=0.3)


def test_a_ball_that_bounces(subject):
    """Through bounces, whose times depend on everything that is fitted."""
    g, e, y = 9.81, 0.8, 10.0
    t, height = np.linspace(0.05, 4.95, 50), []
    for now in t:
        begin, v, h = 0.0, 0.0, y
        while True:
            lands = begin + (v + np.sqrt(v * v + 2 * g * h)) / g
            if lands > now:
                break
            begin, v, h = lands, e * (g * (lands - begin) - v), 0.0
        height.append(h + v * (now - begin) - g / 2 * (now - begin) ** 2)
    noisy = np.array(height) + 0.02 * np.random.default_rng(2).normal(size=50)
    found = run_fit(subject, BALL, "g = 9.6, e = 0.78, y = 9.9 to y ~ height", table(t=t, height=noisy))
    for name, true in (("g", g), ("e", e), ("y", y)):
        assert found[name] == pytest.approx(true, abs=3 * found["errors"][name])
        assert found["errors"][name] < 0.01 * true


def test_a_pendulum_that_hits_a_wall(subject):
    """Figures of an independent integration from bounce to bounce (scipy, DOP853, 1e-11)."""
    from scipy.integrate import solve_ivp

    length, e, start = 1.3, 0.7, 0.6
    t, place, begin, seen = np.linspace(0.0, 3.9, 40), np.array([start, 0.0]), 0.0, []

    def slope(_t, z):
        return [z[1], -9.81 / length * np.sin(z[0])]

    def wall(_t, z):
        return z[0]

    wall.terminal, wall.direction = True, -1
    while begin < t[-1]:
        swing = solve_ivp(
            slope, (begin, 4.0), place, "DOP853", events=wall, dense_output=True, rtol=1e-11, atol=1e-12
        )
        seen.append(swing.sol(t[(t >= begin) & (t < swing.t[-1])])[0])
        begin, place = swing.t[-1], np.array([0.0, -e * swing.y[1, -1]])
    text = """l = 1 | e = 0.8 | a = 0.5 | w = 0 | irule 3 | TMAX = 4 | DT = 0.005 | NN = 41
drun
DYNAMIC
d/dt a = w
d/dt w = -9.81/l*sin(a)
dispt a
event -a
w = -e*w | a = 0
"""
    found = run_fit(subject, text, "l, e in [0, 1], a to a ~ angle", table(t=t, angle=np.concatenate(seen)))
    assert [found[name] for name in ("l", "e", "a")] == pytest.approx([length, e, start], rel=1e-7)


def test_two_quantities_of_different_size(subject):
    """Each has a standard deviation of its own, found from the residuals."""
    t = np.arange(0.0, 61.0, 1.0)
    exact = subject(SIR, settings={"b": 0.4, "g": 0.1}).model.run(set={"b": 0.4, "g": 0.1}, record=["flow"])
    at = np.searchsorted(exact.t, t - 1e-9)
    generator = np.random.default_rng(4)
    file = table(
        t=t,
        J=exact["J"][at] + 8 * generator.normal(size=61),
        f=exact["flow"][at] + 0.3 * generator.normal(size=61),
    )
    found = run_fit(subject, SIR, "b, g to J, flow ~ f", file)
    assert found["standard deviation of J"] == pytest.approx(8, rel=0.3)
    assert found["standard deviation of flow"] == pytest.approx(0.3, rel=0.3)
    assert found["b"] == pytest.approx(0.4, abs=4 * found["errors"]["b"])


def test_several_data_sets_with_settings_of_their_own(subject):
    first = DataFile("a.csv", {"t": T, "x": decay(T, 0.7, 2.0)}, {"x": 2.0})
    second = DataFile("b.csv", {"t": T[:20], "x": decay(T[:20], 0.7, 5.0)}, {"x": 5.0})
    found = run_fit(subject, DECAY, "k to x", first, second)
    assert found["k"] == pytest.approx(0.7, abs=1e-7)
    assert len(found["residuals"]) == 69
    assert [chart.title for chart in found.charts] == [
        "Residuals of a.csv", "x and a.csv", "Residuals of b.csv", "x and b.csv",
    ]  # fmt: skip


def test_a_robust_loss_lets_outliers_be(subject):
    data = decay(T, 0.7, 3.2, 0.02, seed=8)
    data[::7] += 3
    plain = run_fit(subject, DECAY, "k, x to x", table(t=T, x=data))
    for loss in ("soft_l1", "huber", "cauchy", "arctan"):
        found = run_fit(subject, DECAY, f"k, x to x loss {loss}", table(t=T, x=data))
        assert abs(found["k"] - 0.7) < 0.03
        assert abs(found["k"] - 0.7) < 0.1 * abs(plain["k"] - 0.7)


def test_missing_values_are_no_values(subject):
    data = decay(T, 0.7, 3.2)
    data[3] = np.nan
    found = run_fit(subject, DECAY, "k, x to x", table(t=T, x=data))
    assert len(found["residuals"]) == 48
    assert found["k"] == pytest.approx(0.7, abs=1e-7)


def test_values_outside_the_run_are_told(subject):
    t = np.linspace(0, 8, 17)
    found = run_fit(subject, DECAY, "k, x to x", table(t=t, x=decay(t, 0.7, 3.2)))
    assert "made.csv: 6 values outside the run are left out" in found.notes


def test_a_bound_is_told(subject):
    found = run_fit(subject, DECAY, "k in [0.9, 2], x to x", table(t=T, x=decay(T, 0.7, 3.2)))
    assert found["k"] == pytest.approx(0.9, abs=1e-5)
    assert any("k stands at its bound 0.9" in note for note in found.notes)


def test_combinations_that_cannot_be_told_apart(subject):
    text = DECAY.replace("c = 0", "c = 1").replace("-k*x", "-k*c*x")
    found = run_fit(subject, text, "k, c, x to x", table(t=T, x=decay(T, 0.7, 3.2, 0.01)))
    assert any(note.startswith("k, c cannot be identified") for note in found.notes)
    assert np.isinf(found["errors"]["k"])
    assert np.isfinite(found["errors"]["x"])
    assert found["k"] * found["c"] == pytest.approx(0.7, rel=0.02)


def test_an_end_before_convergence_says_so(subject):
    found = run_fit(subject, DECAY, "k = 5, x to x runs 2", table(t=T, x=decay(T, 0.7, 3.2)))
    assert not found["converged"]
    assert found.notes[0].startswith("no convergence: ended after 2 runs")


def test_it_can_be_stopped_and_shows_how_far_it_is(subject):
    shown = []

    def watch(part, told, so_far=None):
        shown.append(so_far)
        return len(shown) < 5

    file = table(t=T, x=decay(T, 0.7, 3.2))
    found = fit(subject(DECAY), read_request("k = 4, x to x"), [file], watch)
    assert found.is_partial
    assert shown[-1].charts[0].series[0].look == "points"
    assert len(shown[-1].charts[0].series[1].x) > 2


def test_the_band_holds_the_curve(subject):
    found = run_fit(subject, DECAY, "k, x to x", table(t=T, x=decay(T, 0.7, 3.2, 0.1, seed=1)))
    (band,) = (series for series in found.charts[-1].series if series.look == "dashes")
    count = len(band.x) // 2
    t, low, high = band.x[:count], band.y[:count], band.y[count + 1 :]
    true = decay(t, 0.7, 3.2)
    assert np.mean((low <= true) & (true <= high)) > 0.9
    assert high[0] - low[0] == pytest.approx(2 * 2.0117 * found["errors"]["x"], rel=1e-3)  # t(0.975, 47)


@pytest.mark.parametrize(
    ("request_", "message"),
    [
        ("k", "the request ends where 'to' is expected"),
        ("k in [5, 1] to x", "the interval from 5 to 1 holds nothing"),
        ("kk to x", "'kk' is no parameter or state"),
        ("k to x ~ height", "made.csv has no column 'height'"),
        ("k to x ~ y loss l3", "'l3' is no loss"),
        ("k to x ~ y runs 0.5", "0.5 is no whole number from 1 on"),
        ("k to x ~ y weights 0", "a standard deviation of 0 has no weight"),
        ("k to x ~ y weights zero", "made.csv has weights in zero that are not above 0"),
        ("k to q ~ y", "'q' is to be recorded, but the program does not have it"),
        ("k, unused to x ~ y",
         "unused cannot be identified: no influence on x at the times of the data"),
    ],
)  # fmt: skip
def test_mistakes(subject, request_, message):
    assert problem(subject, DECAY, request_, table(t=T, y=T, zero=0 * T)).message == message


def test_data_that_do_not_overlap_the_run(subject):
    found = problem(subject, DECAY, "k to x", table(t=T + 100, x=T))
    assert found.message == (
        "the data of made.csv go from t = 100.1 to 104.9, the run from 0 to 5: they do not overlap"
    )


def test_a_run_that_fails_at_the_start(subject):
    text = DECAY.replace("-k*x", "-k*sqrt(x - 2)")
    assert problem(subject, text, "k to x", table(t=T, x=T)).message.startswith(
        "the run fails where the fit begins"
    )


def test_a_file_sets_what_is_fitted(subject):
    file = DataFile("a.csv", {"t": T, "x": T}, {"k": 2.0})
    assert problem(subject, DECAY, "k to x", file).message == "a.csv sets k, which is to be fitted"


def test_without_data_and_with_files_that_are_wrong(subject, tmp_path):
    with pytest.raises(DesireError, match="no measurements"):
        analyse(subject(DECAY), "k to x", unwatched)
    paths = tuple(tmp_path / name for name in ("a.csv", "b.csv"))
    paths[0].write_text("t,x\n0,one\n")
    paths[1].write_text("t,x\n0\n")
    with pytest.raises(DesireError) as error:
        analyse(subject(DECAY, data=paths), "k to x", unwatched)
    assert [d.key for d in error.value.diagnostics] == ["data-cell", "data-ragged"]


def test_files_from_the_shell(tmp_path):
    from click.testing import CliRunner

    from desire_tui.cli import main

    (tmp_path / "decay.src").write_text(DECAY)
    lines = [f"{t:g};{value:.6f}".replace(".", ",") for t, value in zip(T, decay(T, 0.7, 3.2), strict=True)]
    (tmp_path / "made.csv").write_text("\n".join(["t (s);height [m]", *lines]))
    words = [
        "fit",
        str(tmp_path / "decay.src"),
        "k,",
        "x",
        "to",
        "x",
        "~",
        "height",
        "--data",
        str(tmp_path / "made.csv"),
    ]
    shown = CliRunner().invoke(main, [*words, "-o", str(tmp_path / "fit.png")], catch_exceptions=False)
    assert shown.exit_code == 0, shown.output
    assert "0.7" in shown.output
    assert Path(tmp_path / "fit-2.png").is_file() or Path(tmp_path / "fit-1.png").is_file()


def test_cubics_through_four_samples_are_exact_for_cubics():
    t = np.array([0.0, 1.0, 1.5, 3.0, 4.0, 7.0])
    wanted = np.array([0.0, 0.2, 1.5, 2.9, 6.0, 7.0])
    places, weights = cubic_weights(t, wanted)
    assert np.einsum("ij,ij->i", (t**3 - t)[places], weights) == pytest.approx(wanted**3 - wanted)


def test_files_beside_the_program_are_named_in_the_request(subject, tmp_path):
    from desire_tui.analysis.subject import Subject
    from desire_tui.engine.source import Source

    (tmp_path / "program").mkdir()
    lines = [f"{t:g},{value:.9f}" for t, value in zip(T, decay(T, 0.7, 3.2), strict=True)]
    for folder in (tmp_path, tmp_path / "program"):
        (folder / "made.csv").write_text("\n".join(["t,x", *lines]))
    program = Subject(Source(DECAY, "decay.src", tmp_path / "program" / "decay.src"))
    found = analyse(program, "k, x to x from 'made.csv' loss linear", unwatched)
    assert found["k"] == pytest.approx(0.7, abs=1e-6)
    with pytest.raises(DesireError, match="451"):
        analyse(program, "k, x to x from '../made.csv'", unwatched)
    with pytest.raises(DesireError, match="38"):
        analyse(program, "k, x to x from 'other.csv'", unwatched)


def test_points_over_the_curves_as_they_are(subject, tmp_path):
    path = tmp_path / "made.csv"
    path.write_text("t,height\n0,1.5\n1,0.4\n2,\n4,0.1\n")
    found = compare(subject(DECAY, data=(path,)), "x ~ height", unwatched)
    (row,) = found["deviations"]
    off = np.array([1.5, 0.4, 0.1]) - np.exp([-0.0, -1.0, -4.0])
    assert row["points"] == 3
    assert row["root mean square"] == pytest.approx(np.sqrt(np.mean(off**2)), rel=1e-6)
    assert row["largest"] == pytest.approx(0.5)
    points, curve = found.charts[0].series
    assert points.look == "points"
    assert points.y.tolist() == [1.5, 0.4, 0.1]
    assert curve.y[-1] == pytest.approx(np.exp(-4), rel=1e-6)
    with pytest.raises(DesireError, match="has no column 'x'"):
        compare(subject(DECAY, data=(path,)), "x", unwatched)
